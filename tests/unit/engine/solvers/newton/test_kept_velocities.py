"""Velocities are sums of impulses, whatever impulses rounds of Newton's method tried meanwhile."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, put_vector, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.solvers.newton import method
from lavendersim.engine.solvers.newton.envelope import allocate_envelope
from lavendersim.engine.solvers.newton.kept_velocities import (
    OF_BEST,
    OF_START,
    make_keep_velocities,
    make_put_velocities,
    make_speed,
)
from lavendersim.engine.solvers.newton.method import make_newton, step_cost
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

SPEC = Spec(("contact_torque", "frictionless_contact", "newton", "rotation"))


def squeezed(rng: np.random.Generator, pairs: list[tuple[int, int]]) -> Drawn:
    """Rows that contradict: bodies are to part along a normal, and against it."""
    scene = drawn(SPEC, rng, pairs)
    for axis in "xyz":
        scene.contacts[f"n{axis}"][1] = -scene.contacts[f"n{axis}"][0]
        for name in (f"lever_a{axis}", f"lever_b{axis}", f"turn_a{axis}", f"turn_b{axis}"):
            scene.contacts[name][1] = -scene.contacts[name][0]
    for name in ("k_n", "inv_k"):
        scene.contacts[name][1] = scene.contacts[name][0]
    scene.contacts["target"], scene.contacts["lambda_n"] = -3e4, 0.0
    return scene


def test_what_newton_takes_back_leaves_no_digit_of_it_behind(rng, monkeypatch) -> None:
    """Rounds that are all worse than the start: velocities are those of the start, to the bit.

    Impulses of 1e8 N s and more are tried, of which 1e-16 is far above the last digit of 1 m/s.
    """
    tried = [0.0]
    respond = interpreted(method.make_projected_impulse(SPEC))

    def watched(contact, length):
        found = respond(contact, length)
        tried[0] = max(tried[0], abs(found[0]))
        return found

    def worse(contacts, count, velocities):
        return 1.0 + tried[0], 0

    monkeypatch.setattr(method, "make_projected_impulse", lambda _: watched)
    monkeypatch.setattr(method, "make_residual", lambda _: worse)
    newton = interpreted(make_newton(SPEC))
    for _ in range(5):
        tried[0] = 0.0
        scene = squeezed(rng, [(1, 2), (1, 2)])
        bodies, velocities, contacts = views(scene)
        workspace = records(allocate_envelope(3, 2, 2000))
        system = ContactSystem(contacts, None, 2, bodies, velocities)
        size, _ = interpreted(step_cost)(system, workspace)
        free = scene.motion
        newton(system, workspace, size, 60.0, 1e-9, True)
        assert tried[0] > 1e8
        assert scene.contacts["lambda_n"].tolist() == [0.0, 0.0]
        np.testing.assert_array_equal(scene.motion, free)


@pytest.mark.parametrize("kept", [False, True])
def test_what_newton_takes_back_leaves_no_billionth_of_what_moves(kept, rng, monkeypatch) -> None:
    """Impulses of any size, of rounds that are gone on from or not, and none is the best.

    Below 2^20 of what moves, the largest are set and taken back on two rows, and each of these four
    updates rounds by 2^-54 of it.
    """
    speed, speeds = interpreted(make_speed(SPEC)), []

    def worse(contacts, count, velocities):
        speeds.append(speed(contacts, count, velocities))
        return 1.0 if len(speeds) == 1 else 2.0 if kept else 10.0, 0

    monkeypatch.setattr(method, "make_residual", lambda _: worse)
    newton = interpreted(make_newton(SPEC))
    ratios = []
    for exponent in range(-14, 16, 3):
        speeds.clear()
        scene = squeezed(rng, [(1, 2), (1, 2)])
        scene.contacts["target"] = -(2.0**exponent)
        bodies, velocities, contacts = views(scene)
        workspace = records(allocate_envelope(3, 2, 2000))
        system = ContactSystem(contacts, None, 2, bodies, velocities)
        size, _ = interpreted(step_cost)(system, workspace)
        free = scene.motion
        newton(system, workspace, size, 60.0, 1e-9, True)
        assert scene.contacts["lambda_n"].tolist() == [0.0, 0.0]
        np.testing.assert_allclose(scene.motion, free, rtol=0.0, atol=2.0**-32 * speeds[0])
        ratios.append(max(speeds) / speeds[0])
    assert min(ratios) < 2.0**20 < sorted(ratios)[-2]


@pytest.mark.parametrize("place", [OF_START, OF_BEST])
def test_velocities_are_put_back_to_the_bit(place: int, rng) -> None:
    scene = drawn(SPEC, rng, [(0, 1), (1, 2)])
    bodies, velocities, contacts = views(scene)
    workspace = records(allocate_envelope(3, 2, 2000))
    system = ContactSystem(contacts, None, 2, bodies, velocities)
    size, _ = interpreted(step_cost)(system, workspace)
    before = stacked(scene.velocities)
    interpreted(make_keep_velocities(SPEC))(velocities, workspace, size, place)
    for row in scene.velocities:
        for prefix in ("v", "w"):
            put_vector(row, prefix, rng.normal(size=3))
    after = stacked(scene.velocities)
    interpreted(make_put_velocities(SPEC))(velocities, workspace, size, place)
    # Body 0 is fixed: no row of the system is of it.
    np.testing.assert_array_equal(stacked(scene.velocities)[6:], before[6:])
    np.testing.assert_array_equal(stacked(scene.velocities)[:6], after[:6])


def test_the_speed_is_that_of_normals_or_of_impulses(rng) -> None:
    scene = drawn(SPEC, rng, [(0, 1), (1, 2)])
    _, velocities, contacts = views(scene)
    speed = interpreted(make_speed(SPEC))
    scene.contacts["lambda_n"] = 0.0
    along = (scene.jacobian @ scene.motion)[::3]
    assert speed(contacts, 2, velocities) == pytest.approx(abs(along).max(), rel=1e-13)
    scene.contacts["lambda_n"] = 100.0
    expected = 100.0 * scene.contacts["k_n"].max()
    assert speed(contacts, 2, velocities) == pytest.approx(expected, rel=1e-13)
