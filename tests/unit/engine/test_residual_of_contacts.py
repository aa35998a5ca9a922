"""The residual is zero where a contact has its law, and elsewhere the distance that theory gives.

A closed contact that approaches at v is v off, one that presses and parts at w the smaller of w
and lambda/inv_k, one that should stick and slips its slip. The largest counts, a NaN above all.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, set_contact_velocity, views
from interpreted import interpreted

from lavendersim.engine.residual import make_residual, make_row_residual
from lavendersim.engine.scaled_residual import make_scaled_residual
from lavendersim.engine.spec import Spec

FRICTIONLESS = Spec(effects=("contact_torque", "rotation"))
DISC = Spec(effects=("friction", "rotation"))
PYRAMID, CONVEX = DISC._replace(friction_cone="pyramid"), DISC._replace(friction_cone="convex")
TURNING = DISC.including("torsional_friction", "rolling_friction")


def row(spec: Spec, rng: np.random.Generator, w: Any, impulse: Any, **fields: float) -> Drawn:
    """Return one contact at the velocity w, its target included, and with an impulse."""
    scene = drawn(spec, rng, [(1, 2)], fixed=(0,))
    set_contact_velocity(scene, np.array(w) - [scene.contacts["target"][0], 0.0, 0.0])
    given = dict(zip(("lambda_n", "lambda_1", "lambda_2"), impulse, strict=True)) | fields
    for name, value in given.items():
        if name in (scene.contacts.dtype.names or ()):
            scene.contacts[name] = value
    return scene


def residual(spec: Spec, scene: Drawn) -> float:
    _, velocities, contacts = views(scene)
    r, v_n = interpreted(make_row_residual(spec))(contacts[0], velocities[1], velocities[2])
    assert v_n == pytest.approx(scene.jacobian[0] @ scene.motion, abs=1e-13)
    return r


@pytest.mark.parametrize("spec", [FRICTIONLESS, DISC, PYRAMID, TURNING])
def test_along_the_normal_it_is_what_signorini_lacks(spec: Spec, rng) -> None:
    assert residual(spec, row(spec, rng, (0.3, 0, 0), (0, 0, 0))) == pytest.approx(0.0, abs=1e-13)
    assert residual(spec, row(spec, rng, (0.0, 0, 0), (2.0, 0, 0))) == pytest.approx(0.0, abs=1e-13)
    assert residual(spec, row(spec, rng, (-0.3, 0, 0), (0, 0, 0))) == pytest.approx(0.3, abs=1e-13)
    pressed = row(spec, rng, (0.3, 0, 0), (1e-3, 0, 0))
    expected = 1e-3 / pressed.contacts["inv_k"][0]
    assert residual(spec, pressed) == pytest.approx(min(expected, 0.3), abs=1e-13)
    pulled = row(spec, rng, (0.3, 0, 0), (-0.01, 0, 0))
    expected = 0.01 / pulled.contacts["inv_k"][0]
    if spec is FRICTIONLESS:
        assert residual(spec, pulled) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("spec", [FRICTIONLESS, DISC, CONVEX])
def test_compliance_lets_a_pressed_contact_approach(spec: Spec, rng) -> None:
    spec = spec.including("compliance")
    scene = row(spec, rng, (-0.2, 0, 0), (1.0, 0, 0), gamma=0.2, mu=0.5)
    assert residual(spec, scene) == pytest.approx(0.0, abs=1e-13)


MU = 0.5
SLIDING = np.array([0.0, 0.3, -0.4])  # at 0.5 m/s
AGAINST = np.array([2.0, -0.6, 0.8])  # of size mu times the normal


@pytest.mark.parametrize("spec", [DISC, TURNING])
def test_in_the_tangent_plane_it_is_what_coulomb_lacks(spec: Spec, rng) -> None:
    assert residual(spec, row(spec, rng, SLIDING, AGAINST, mu=MU)) == pytest.approx(0, abs=1e-13)
    # A small impulse in the disc: it should have stopped the slip.
    sticking = row(spec, rng, (0.0, 3e-3, -4e-3), (2.0, 0.1, 0.1), mu=MU)
    assert residual(spec, sticking) == pytest.approx(5e-3, abs=1e-13)
    # Along its slip in place of against it: from one rim of the disc to the other.
    along = row(spec, rng, SLIDING * 1e3, AGAINST * [1, -1, -1], mu=MU)
    expected = 2.0 * MU * 2.0 * along.contacts["k_t"][0]
    assert residual(spec, along) == pytest.approx(expected, rel=1e-13)


def test_the_pyramid_has_its_law_side_by_side(rng) -> None:
    """Each tangent has the whole limit: what slides along both has the corner of the square."""
    corner = row(PYRAMID, rng, SLIDING, (2.0, -1.0, 1.0), mu=MU)
    assert residual(PYRAMID, corner) == pytest.approx(0.0, abs=1e-13)
    assert residual(PYRAMID, row(PYRAMID, rng, SLIDING, AGAINST, mu=MU)) > 1e-2


def test_the_convex_law_lifts_what_slides(rng) -> None:
    lifted = SLIDING + np.array([MU * 0.5, 0.0, 0.0])
    assert residual(CONVEX, row(CONVEX, rng, lifted, AGAINST, mu=MU)) == pytest.approx(0, abs=1e-13)
    assert residual(CONVEX, row(CONVEX, rng, SLIDING, AGAINST, mu=MU)) > 1e-2
    assert residual(DISC, row(DISC, rng, lifted, AGAINST, mu=MU)) > 1e-2
    # Inside the cone all of w is lacking, at the tip what the dual cone has not.
    inside = row(CONVEX, rng, (1e-3, 2e-3, -2e-3), (2.0, 0.1, 0.1), mu=MU)
    assert residual(CONVEX, inside) == pytest.approx(3e-3, abs=1e-13)
    # In both tangents, whatever the impulse that it slides against.
    for turn in (0.3, 2.0, 4.0):
        c, s = np.cos(turn), np.sin(turn)
        slip, push = (
            np.array([MU * 0.7, 0.7 * c, 0.7 * s]),
            np.array([1.9, -1.9 * MU * c, -1.9 * MU * s]),
        )
        assert residual(CONVEX, row(CONVEX, rng, slip, push, mu=MU)) == pytest.approx(0, abs=1e-13)
    closing = row(CONVEX, rng, (-0.3, 0.0, 0.0), (0.0, 0.0, 0.0), mu=MU)
    assert residual(CONVEX, closing) == pytest.approx(0.3, abs=1e-13)


@pytest.mark.parametrize("spec", [TURNING, TURNING._replace(friction_cone="convex")])
def test_a_turning_that_nothing_resists_counts_by_its_arm(spec: Spec, rng) -> None:
    scene = row(spec, rng, (0.0, 0.0, 0.0), (2.0, 0.0, 0.0), mu=MU)
    n = np.array([scene.contacts[f"n{axis}"][0] for axis in "xyz"])
    spin = n @ (scene.motion[15:18] - scene.motion[9:12])
    scene.contacts["arm"], scene.contacts["torsional"], scene.contacts["k_torsion"] = 0.3, 10.0, 1.0
    scene.contacts["k_roll"] = 1.0
    for i, share in ((1, -0.5), (2, 0.5)):
        for axis, value in zip("xyz", n, strict=True):
            scene.velocities[i][f"w{axis}"] += share * value
    found = interpreted(make_row_residual(spec))
    _, velocities, contacts = views(scene)
    slip = (scene.jacobian @ scene.motion)[1:]
    r, _ = found(contacts[0], velocities[1], velocities[2])
    # Spins about n through the arms of the contact let it slip as well: the larger of both counts.
    assert r >= max(0.3 * abs(spin + 1.0), np.hypot(*slip)) - 1e-12
    scene.contacts["arm"] = 1e3
    r, _ = found(contacts[0], velocities[1], velocities[2])
    assert r == pytest.approx(1e3 * abs(spin + 1.0), rel=1e-12)
    scene.contacts["psi_n"] = np.nan
    r, _ = found(contacts[0], velocities[1], velocities[2])
    assert np.isnan(r)


def test_of_many_contacts_the_worst_is_named_and_what_is_no_number_stays(rng) -> None:
    scene = drawn(DISC, rng, [(0, 1), (1, 2), (2, 0), (0, 2)])
    _, velocities, contacts = views(scene)
    single, all_of = interpreted(make_row_residual(DISC)), interpreted(make_residual(DISC))
    each = [single(c, velocities[c.a], velocities[c.b])[0] for c in contacts]
    assert all_of(contacts, 4, velocities) == (max(each), int(np.argmax(each)))
    assert all_of(contacts, 0, velocities) == (0.0, -1)
    scene.contacts["lambda_1"][1] = np.nan
    value, worst = all_of(contacts, 4, velocities)
    assert np.isnan(value)
    assert worst >= 1


def test_a_problem_by_its_matrix_has_the_one_without_units() -> None:
    matrix = Spec(solver="jacobi", operator="matrix", effects=("friction",))
    made, expected = make_residual(matrix), make_scaled_residual(matrix)
    assert made.py_func.__code__ is expected.py_func.__code__
