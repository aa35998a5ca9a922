"""Rounds without shifts end at Coulomb's law: each impulse checked by the law, not by a residual.

Bodies and contacts are drawn at random; a round is checked against dense algebra.
"""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.residual import make_residual
from lavendersim.engine.solvers.newton import alart_curnier, coulomb_response
from lavendersim.engine.solvers.newton.envelope import DOF, allocate_envelope
from lavendersim.engine.solvers.newton.method import step_cost
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.newton.response import PLAIN, make_start
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
# Bodies between each other and on a floor, in more points than hold them.
PAIRS = [(0, 1), (0, 1), (1, 2), (2, 1), (0, 2), (2, 3), (3, 0), (0, 3), (0, 3)]
COUNT = len(PAIRS)


def prepared(rng: np.random.Generator):
    """Return drawn contacts, their system, and a workspace that is laid out for them."""
    scene = drawn(SPEC, rng, PAIRS)
    # Bodies of any inertia that anything pushes at any place jam with more friction.
    scene.contacts["mu"] *= 0.2
    for axis in "12":
        scene.contacts[f"lambda_{axis}"] *= 0.2
    bodies, velocities, contacts = views(scene)
    workspace = records(allocate_envelope(4, COUNT, 2000, upper=2000))
    size, _ = interpreted(step_cost)(
        ContactSystem(contacts, None, COUNT, bodies, velocities), workspace
    )
    return scene, ContactSystem(contacts, None, COUNT, bodies, velocities), workspace, size


def impulses(scene: Drawn, name: str = "lambda") -> np.ndarray:
    return np.stack([scene.contacts[f"{name}_{axis}"] for axis in "n12"], axis=1)


def test_a_root_balances_momentum(rng) -> None:
    scene, system, workspace, size = prepared(rng)
    interpreted(make_assemble_mass(SPEC))(system.bodies, size, workspace)
    interpreted(make_start(SPEC))(system.contacts, COUNT, system.velocities, 0.1, True, PLAIN)
    steps, found = interpreted(alart_curnier.make_find_root(SPEC))(
        system.contacts, COUNT, size, workspace, 1e-12
    )
    assert found
    assert steps > 1
    places = [DOF * int(i) + k for i in workspace.visited[:size] for k in range(DOF)]
    impulse_of = interpreted(coulomb_response.make_coulomb_impulse(SPEC))
    gained = np.array([impulse_of(c, 0.0) for c in system.contacts]) - impulses(scene, "start")
    assert np.abs(gained).max() > 0.1
    momentum = scene.mass[np.ix_(places, places)] @ workspace.change[: DOF * size]
    # A change of 1e-12 m/s by the stiffness 1/(0.1 k), some 10 kg, is what is left.
    np.testing.assert_allclose(momentum, scene.jacobian[:, places].T @ gained.ravel(), atol=1e-9)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_rounds_end_at_coulombs_law(seed: int) -> None:
    """Of problems that are found from far; of others it is asked only what sweeps leave."""
    scene, system, workspace, size = prepared(np.random.default_rng(seed))
    free = scene.motion - scene.inverse @ scene.jacobian.T @ impulses(scene).ravel()
    solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
    assert 0 < solve(system, workspace, size, 400.0, 1e-11, 1e-9) < 400
    found = impulses(scene)
    motion = free + scene.inverse @ scene.jacobian.T @ found.ravel()
    np.testing.assert_allclose(stacked(scene.velocities), motion, atol=1e-12)
    w = (scene.jacobian @ motion).reshape(-1, 3)
    w[:, 0] += scene.contacts["target"]
    # Residuals of 1e-9 m/s, of impulses too by masses of some kilograms.
    near = 1e-8
    for impulse, velocity, mu in zip(found, w, scene.contacts["mu"], strict=True):
        push, slip = np.hypot(*impulse[1:]), np.hypot(*velocity[1:])
        assert min(impulse[0], velocity[0]) == pytest.approx(0.0, abs=near)
        assert push <= mu * impulse[0] + 1e-14
        if slip > 1e-6 and impulse[0] > 1e-6:  # it slides, and friction opposes it
            assert push == pytest.approx(mu * impulse[0], abs=near)
            np.testing.assert_allclose(impulse[1:] * slip, -push * velocity[1:], atol=near)
    assert (found[:, 0] > 1e-6).any()


@pytest.mark.parametrize("seed", [0, 4])
def test_what_is_not_found_is_left_no_worse(seed: int) -> None:
    """Draws that may jam: rounds that went astray are taken back, with their velocities."""
    scene, system, workspace, size = prepared(np.random.default_rng(seed))
    free = scene.motion - scene.inverse @ scene.jacobian.T @ impulses(scene).ravel()
    residual = interpreted(make_residual(SPEC))
    before, _ = residual(system.contacts, COUNT, system.velocities)
    interpreted(alart_curnier.make_alart_curnier(SPEC))(system, workspace, size, 30.0, 1e-11, 1e-9)
    after, _ = residual(system.contacts, COUNT, system.velocities)
    assert after <= before
    motion = free + scene.inverse @ scene.jacobian.T @ impulses(scene).ravel()
    # Velocities of 10 m/s at most, as each of some twenty rounds is added and taken back.
    np.testing.assert_allclose(stacked(scene.velocities), motion, atol=1e-11)


def test_what_is_solved_is_left_as_it_is(rng) -> None:
    scene, system, workspace, size = prepared(rng)
    before = scene.contacts.copy()
    solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
    assert solve(system, workspace, size, 400.0, 1e-11, 1e3) == 0
    assert (scene.contacts == before).all()


def test_without_friction_there_are_no_shifts_to_do_without() -> None:
    smooth = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
    assert alart_curnier.make_alart_curnier(smooth) is None
