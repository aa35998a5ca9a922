"""From inside the cones to Coulomb's law: each impulse checked by the law, not by a residual."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import stacked
from drawn_systems import COUNT, assert_coulombs_law, drawn_system, impulses
from interpreted import interpreted

from lavendersim.engine.residual import make_residual
from lavendersim.engine.solvers.newton import inside_cones
from lavendersim.engine.solvers.newton.cone_scaling import SOFTNESS, scaling_of, unscaled
from lavendersim.engine.solvers.newton.inside_cones import LONG_STEPS, SHORT_STEPS, serves
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


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 4, 5])
def test_rounds_from_there_end_at_coulombs_law(seed: int) -> None:
    """Of draws 0 and 4 too, where rounds from the impulses as drawn may jam."""
    drawn = drawn_system(SPEC, np.random.default_rng(seed))
    begin_again = interpreted(inside_cones.make_begin_again(SPEC))
    begin_again(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9))
    assert_coulombs_law(drawn)


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


def test_contacts_without_friction_push_along_their_normals_alone(rng) -> None:
    mixed = SPEC.including("contact_torque", "frictionless_contact")
    drawn = drawn_system(mixed, rng)
    drawn.scene.contacts["frictional"][::2], drawn.scene.contacts["mu"][::2] = 0, 0.0
    before = drawn.scene.contacts.copy()
    for axis in "12":
        drawn.scene.contacts[f"lambda_{axis}"][::2] = 0.0
    lost = impulses(drawn.scene) - np.stack([before[f"lambda_{k}"] for k in "n12"], axis=1)
    moved = drawn.scene.inverse @ drawn.scene.jacobian.T @ lost.ravel()
    for row, change in zip(drawn.scene.velocities, moved.reshape(-1, 6), strict=True):
        for name, value in zip(("vx", "vy", "vz", "wx", "wy", "wz"), change, strict=True):
            row[name] += value
    begin_again = interpreted(inside_cones.make_begin_again(mixed))
    begin_again(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9))
    assert (impulses(drawn.scene)[::2, 1:] == 0.0).all()
    assert_coulombs_law(drawn)


@pytest.mark.parametrize("better", [True, False])
def test_what_is_no_better_is_taken_back(better: bool, monkeypatch) -> None:
    """Of impulses by a script, twice as large or none, where 0 is what the law asks for."""
    drawn = drawn_system(SPEC, np.random.default_rng(5))
    drawn.scene.contacts["target"] = 50.0  # all open
    before = impulses(drawn.scene)
    set_impulse = interpreted(inside_cones.make_set_impulse(SPEC))

    def scripted(system: Any, *_: Any) -> int:
        for contact, own in zip(system.contacts, before, strict=True):
            set_impulse(contact, system.velocities, *(own * (0.0 if better else 2.0)))
        return 7

    monkeypatch.setattr(inside_cones, "make_from_inside", lambda spec: scripted)
    monkeypatch.setattr(inside_cones, "make_alart_curnier", lambda spec: lambda *_: 0)
    begin_again = interpreted(inside_cones.make_begin_again(SPEC))
    steps = begin_again(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9))
    assert steps == (7 if better else 14)  # by each strategy
    expected = np.zeros((COUNT, 3)) if better else before
    # A sum of two impulses below 2 N s, and one of velocities.
    np.testing.assert_allclose(impulses(drawn.scene), expected, atol=1e-15)
    np.testing.assert_allclose(stacked(drawn.scene.velocities), drawn.motion, atol=1e-12)


def test_what_is_solved_is_left_alone(rng) -> None:
    drawn = drawn_system(SPEC, rng)
    before = drawn.scene.contacts.copy()
    begin_again = interpreted(inside_cones.make_begin_again(SPEC))
    assert begin_again(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e3)) == 0
    assert (drawn.scene.contacts == before).all()


def test_it_serves_contacts_that_are_a_cone_each() -> None:
    assert serves(SPEC)
    for other in ("compliance", "rolling_friction", "torsional_friction", "joint"):
        assert not serves(SPEC.including(other)), other
    assert not serves(Spec(effects=("contact_torque", "newton"), solver="adaptive"))
    assert not serves(Spec(effects=("friction", "rotation"), solver="adaptive"))
