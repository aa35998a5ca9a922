"""Turns of bodies: by Cayley's map, exactly in substeps, and of what a step all but stops.

Exact is Rodrigues' formula.
"""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from test_integrate import CENTRED, DT, ORIENT, UNEVEN, Body

from lavendersim.engine import body_turn
from lavendersim.engine.integrate import LASTING
from lavendersim.engine.records import BOX, SPHERE

SUBSTEPS = CENTRED.including("error_control")


@pytest.mark.parametrize(("share", "mean"), [(65.0, False), (63.0, True)])
def test_a_spin_that_is_all_but_stopped_does_not_turn_by_its_mean(share: float, mean: bool) -> None:
    """64 times slower it is the round-off of what cancels."""
    body = Body(UNEVEN, np.random.default_rng(1))
    body.gives(m_w=(0, 0, 1.0), w=(0, 0, 1.0 / share))
    body.moved(UNEVEN)
    expected = 0.5 * (1.0 + 1.0 / share) if mean else 1.0 / share
    np.testing.assert_allclose(body.angle(), (0.0, 0.0, expected * DT), atol=1e-14)


@pytest.mark.parametrize("halves", [True, False])
def test_a_needle_that_turns_far_gets_all_of_its_spin_before_the_turn(halves: bool, rng) -> None:
    """Turned about its first axis, what it gains along the second goes over to the third.

    I_1^-1 I_0 g is g (0, cos, -sin/I_3) in axes of the body, and g itself (0, cos, -sin): they
    differ by sin (1/I_3 - 1), and LIKE is the limit of it.
    """
    w = 30.0
    sine = np.sin(2.0 * np.arctan(0.5 * w * DT))
    thin = 1.0 / (1.0 + body_turn.LIKE / sine * (1.0 - 1e-3 if halves else 1.0 + 1e-3))
    moments = (1.0, 1.0, thin)
    body, plain = Body(UNEVEN, rng, moments), Body(UNEVEN, rng, moments)
    for name in ("qw", "qx", "qy", "qz"):
        plain.rows[name] = body.rows[name]
    ORIENT(plain.row)
    before, gained = w * body.frame[:, 0], 1e-6 * body.frame[:, 1]  # too little to bend the turn
    body.gives(m_w=before, w=before + gained)
    plain.gives(w=before + gained)
    body.moved(UNEVEN)
    interpreted(body_turn.make_turn(UNEVEN))(plain.row, plain.v, DT)
    assert (body.turn() == plain.turn()).all() == (not halves)
    assert (body.spin() == plain.spin()).all() == (not halves)


def turned_exactly(body: Body, w: np.ndarray) -> np.ndarray:
    """Return by how much it is off, of a turn by w DT (Rodrigues)."""
    size = np.linalg.norm(w)
    x, y, z = w / size
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(size * DT) * across + (1 - np.cos(size * DT)) * across @ across
    return np.asarray(abs(body.turn() - turn @ body.frame).max())


@pytest.mark.parametrize("speed", [1e-6, 0.3, 12.0, 40.0, 300.0, 1e4])
def test_in_substeps_what_keeps_its_spin_turns_exactly(speed: float, rng) -> None:
    """From a turn of 2e-8 rad to one of 200, of which each doubling doubles the rounding."""
    w = speed * random_frame(rng)[0]
    body = Body(SUBSTEPS, rng).gives(w=w, m_w=w)
    body.moved(SUBSTEPS)
    assert turned_exactly(body, w) <= 1e-15 * (4.0 + 4.0 * speed * DT)


@pytest.mark.parametrize("kind", ["ball", "kinematic", "box", "twisted", "uneven"])
def test_in_substeps_others_turn_by_cayleys_map(kind: str, rng) -> None:
    """What a contact carries by the mean spin, but for balls; what torques turn, or its inertia."""
    w, v = rng.normal(size=3) * 9.0, rng.normal(size=3)
    body = Body(SUBSTEPS, rng, (1, 2, 3) if kind == "uneven" else (1, 1, 1))
    body.rows["shape"] = SPHERE if kind == "ball" else BOX
    gained = rng.normal(size=3) * (kind == "twisted")
    body.gives(v=v, m_v=v, w=w + gained, m_w=w)
    if kind == "kinematic":
        body.rows["inv_m"], body.rows["inv_ix"] = 0.0, 0.0
        body.rows["inv_iy"] = body.rows["inv_iz"] = 0.0
    if kind in ("ball", "kinematic", "box"):
        body.motion["carried"] = LASTING
    body.moved(SUBSTEPS)
    exact = turned_exactly(body, w + 0.5 * gained) < 1e-14
    assert exact == (kind in ("ball", "kinematic"))
    if kind in ("box", "twisted"):
        assert body.angle() == pytest.approx((w + 0.5 * gained) * DT, rel=1e-12)
