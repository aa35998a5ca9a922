"""Rounds without shifts end at Coulomb's law: each impulse checked by the law, not by a residual.

Bodies and contacts are drawn at random; a round is checked against dense algebra.
"""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import stacked
from drawn_systems import COUNT, assert_coulombs_law, drawn_system, impulses
from interpreted import interpreted

from lavendersim.engine.residual import make_residual
from lavendersim.engine.solvers.newton import alart_curnier, coulomb_response
from lavendersim.engine.solvers.newton.envelope import DOF
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.newton.response import PLAIN, make_start
from lavendersim.engine.solvers.newton.rounds import SOFTEST
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")


def test_a_root_balances_momentum(rng) -> None:
    scene, system, workspace, size, _ = drawn_system(SPEC, rng)
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
    drawn = drawn_system(SPEC, np.random.default_rng(seed))
    solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
    steps = solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), SOFTEST)
    assert 0 < steps < 400
    assert_coulombs_law(drawn)


@pytest.mark.parametrize("seed", [0, 4])
def test_what_is_not_found_is_left_no_worse(seed: int) -> None:
    """Draws that may jam: rounds that went astray are taken back, with their velocities."""
    drawn = drawn_system(SPEC, np.random.default_rng(seed))
    system, residual = drawn.system, interpreted(make_residual(SPEC))
    before, _ = residual(system.contacts, COUNT, system.velocities)
    solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
    solve(system, drawn.workspace, drawn.size, 30.0, (1e-11, 1e-9), SOFTEST)
    after, _ = residual(system.contacts, COUNT, system.velocities)
    assert after <= before
    # Velocities of 10 m/s at most, as each of some twenty rounds is added and taken back.
    np.testing.assert_allclose(stacked(drawn.scene.velocities), drawn.motion, atol=1e-11)


def test_what_is_solved_is_left_as_it_is(rng) -> None:
    scene, system, workspace, size, _ = drawn_system(SPEC, rng)
    before = scene.contacts.copy()
    solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
    assert solve(system, workspace, size, 400.0, (1e-11, 1e3), SOFTEST) == 0
    assert (scene.contacts == before).all()


def test_without_friction_there_are_no_shifts_to_do_without() -> None:
    smooth = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
    assert alart_curnier.make_alart_curnier(smooth) is None
