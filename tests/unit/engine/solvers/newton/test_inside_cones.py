"""From inside the cones to Coulomb's law: each impulse checked by the law, not by a residual."""

from __future__ import annotations

from functools import partial
from itertools import chain, repeat
from typing import Any

import numpy as np
import pytest
from drawn_contacts import stacked
from drawn_systems import COUNT, drawn_system, impulses
from interpreted import interpreted

from lavendersim.engine.residual import make_residual
from lavendersim.engine.solvers.newton import inside_cones
from lavendersim.engine.solvers.newton.cone_scaling import SOFTNESS, scaling_of, unscaled
from lavendersim.engine.solvers.newton.inside_cones import LONG_STEPS, SHORT_STEPS
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")


@pytest.mark.parametrize("strategy", [LONG_STEPS, SHORT_STEPS])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_method_comes_near(seed: int, strategy: Any) -> None:
    """Up to what softness leaves: its share of the last changes, of velocities of 10 m/s."""
    drawn = drawn_system(SPEC, np.random.default_rng(seed))
    system, residual = drawn.system, interpreted(make_residual(SPEC))
    before, _ = residual(system.contacts, COUNT, system.velocities)
    solve = interpreted(inside_cones.make_from_inside(SPEC))
    assert 5 < solve(system, drawn.workspace, drawn.size, 80.0, strategy, 1e-9) <= 80
    left, _ = residual(system.contacts, COUNT, system.velocities)
    assert left < 10.0 * SOFTNESS * before
    # Impulses of some 10 N s that were added some eighty times.
    np.testing.assert_allclose(stacked(drawn.scene.velocities), drawn.motion, atol=1e-11)


@pytest.mark.parametrize("share", [1.0, 0.0])
@pytest.mark.parametrize("steps", [0, 6])
def test_a_step_solves_the_linear_equations(steps: int, share: float) -> None:
    """u + du = w + dw + mu (|u_t| + share d.du_t) e_n, dw by momentum; softness taken off du."""
    scene, system, workspace, size, _ = drawn_system(SPEC, np.random.default_rng(1))
    solve = interpreted(inside_cones.make_from_inside(SPEC))
    solve(system, workspace, size, float(steps), LONG_STEPS, 0.0)
    factorise = interpreted(inside_cones.make_factorise_inside(SPEC))
    assert factorise(system.contacts, COUNT, size, workspace, share)
    find = interpreted(inside_cones.make_find_direction(SPEC))
    aim = 1e-3
    find(system.contacts, COUNT, size, system.velocities, workspace, aim)
    mu, k = scene.contacts["mu"], 1.0 / scene.contacts["inv_k"]
    change, u = impulses(scene, "step"), impulses(scene, "velocity")
    rise = np.array([own[:3] for own in workspace.inside])
    impulse = impulses(scene)
    circular = np.stack([mu, np.ones(COUNT), np.ones(COUNT)], axis=1)
    hard = rise - SOFTNESS * k[:, None] * circular**2 * change
    w = (scene.jacobian @ stacked(scene.velocities)).reshape(-1, 3)
    w[:, 0] += scene.contacts["target"]
    w += (scene.jacobian @ scene.inverse @ scene.jacobian.T @ change.ravel()).reshape(-1, 3)
    side = np.hypot(u[:, 1], u[:, 2])
    slip = u[:, 1:] / np.where(side > 0.0, side, 1.0)[:, None]
    w[:, 0] += mu * (side + share * (slip * hard[:, 1:]).sum(axis=1))
    # Gains are 1e6 of what contacts respond with at most: so much of round-off.
    np.testing.assert_allclose(u + hard, w, atol=1e-9)
    # The scaled point moves to `aim` of its inverse: z + dz + H dx = aim R x / det x.
    for c in range(COUNT):
        x, z = circular[c] * impulse[c], u[c] / circular[c]
        dx, dz = circular[c] * change[c], rise[c] / circular[c]
        scaling = interpreted(scaling_of)(Vec3(*x), Vec3(*z))
        inverse = np.array([1.0, -1.0, -1.0]) * x / (x[0] ** 2 - x[1] ** 2 - x[2] ** 2)
        back = interpreted(unscaled)(scaling, 0.0, Vec3(*(aim * inverse - z - dz)))
        np.testing.assert_allclose(back, dx, atol=1e-7)


@pytest.mark.parametrize("tried", [1e10, np.nan])
def test_steps_that_are_taken_back_leave_no_digit_behind(tried: float, monkeypatch) -> None:
    """Steps of so many newton seconds, by a script, after which the beginning is the best.

    Added and taken back they leave 1e-16 of themselves: 1e-6 m/s, of bodies of a kilogram.
    """

    def scripted(contacts: Any, *_: Any) -> None:
        for contact in contacts:
            contact.step_n = contact.step_1 = contact.step_2 = tried

    monkeypatch.setattr(inside_cones, "make_find_direction", lambda _: scripted)
    lengths = (lambda *_: (1.0, 0.5)), (lambda *_: (1.0, 1.0))
    monkeypatch.setattr(inside_cones, "make_choose_length", lambda _: lengths)
    found = []
    for enough in (1.0, 0.0):  # the beginning is enough, or nothing is
        left = chain((1.0,), repeat(tried))
        residual = partial(next, left)
        monkeypatch.setattr(
            inside_cones, "make_residual", lambda _, r=residual: lambda *_: (r(), 0)
        )
        drawn = drawn_system(SPEC, np.random.default_rng(1))
        solve = interpreted(inside_cones.make_from_inside(SPEC))
        steps = solve(drawn.system, drawn.workspace, drawn.size, 3.0, LONG_STEPS, enough)
        assert (steps > 0) == (enough == 0.0)
        found.append((impulses(drawn.scene), stacked(drawn.scene.velocities)))
    np.testing.assert_array_equal(*(one for one, _ in found))
    np.testing.assert_array_equal(*(other for _, other in found))
