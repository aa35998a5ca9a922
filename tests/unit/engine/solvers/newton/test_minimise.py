"""A round ends where momentum balances what contacts answer: M dv = J^T (lambda(v) - lambda^k).

lambda(v) is the projected impulse (`test_response`), the gradient that of dense algebra.
"""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.solvers.newton import minimise, response
from lavendersim.engine.solvers.newton.envelope import (
    DOF,
    OF_A,
    OF_B,
    Envelope,
    allocate_envelope,
    lay_out,
)
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("compliance", "friction", "newton", "rotation"), solver="adaptive")
FRICTIONLESS = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
SPECS = pytest.mark.parametrize(
    "spec", [FRICTIONAL, FRICTIONLESS], ids=["friction", "frictionless"]
)
PAIRS = [(0, 1), (1, 2), (2, 1), (3, 1), (3, 2), (0, 3), (0, 3)]


def begun(spec: Spec, rng: np.random.Generator) -> tuple[Drawn, Envelope, int, list[int]]:
    """Return a round that begins, and the numbers of its rows in the dense matrices."""
    scene = drawn(spec, rng, PAIRS)
    bodies, velocities, contacts = views(scene)
    workspace = records(allocate_envelope(4, len(PAIRS), 2000))
    size, _, _ = interpreted(lay_out)(contacts, len(PAIRS), workspace)
    interpreted(minimise.make_assemble_mass(spec))(bodies, size, workspace)
    start = interpreted(response.make_start(spec))
    start(contacts, len(PAIRS), velocities, 0.05, True, False)
    places = [DOF * int(i) + k for i in workspace.visited[:size] for k in range(DOF)]
    return scene, workspace, size, places


def of_axes(scene: Drawn, name: str) -> np.ndarray:
    return np.stack([scene.contacts[f"{name}_{axis}"] for axis in "n12"], axis=1)


@SPECS
def test_the_minimum_balances_momentum_to_round_off(spec: Spec, rng) -> None:
    scene, workspace, size, places = begun(spec, rng)
    jacobian, before = scene.jacobian[:, places], of_axes(scene, "velocity")
    contacts = records(scene.contacts)
    steps, found = interpreted(minimise.make_minimise(spec))(
        contacts, len(PAIRS), size, workspace, 0.0
    )
    assert found
    assert steps > 1
    change = workspace.change[: DOF * size]
    after = of_axes(scene, "velocity")
    kept = slice(None) if spec is FRICTIONAL else slice(1)
    expected = before + (jacobian @ change).reshape(-1, 3)
    np.testing.assert_allclose(after[:, kept], expected[:, kept], atol=1e-13)
    project = interpreted(response.make_projected_impulse(spec))
    impulses = np.array([project(contact, 0.0) for contact in contacts])
    gained = impulses - of_axes(scene, "start")
    assert np.abs(gained).max() > 0.1
    gradient = scene.mass[np.ix_(places, places)] @ change - jacobian.T @ gained.ravel()
    # Slopes end at 1e-20 of the first: gradients at 1e-10 of it, some 1 N s.
    np.testing.assert_allclose(gradient, 0.0, atol=1e-9)


@SPECS
def test_a_step_changes_the_velocities_of_contacts_by_the_jacobian(spec: Spec, rng) -> None:
    scene, workspace, size, places = begun(spec, rng)
    step = rng.normal(size=DOF * size)
    workspace.step[: DOF * size] = step
    derive = interpreted(minimise.make_directional_derivative(spec))
    derive(records(scene.contacts), len(PAIRS), workspace)
    expected = (scene.jacobian[:, places] @ step).reshape(-1, 3)
    kept = slice(None) if spec is FRICTIONAL else slice(1)
    np.testing.assert_allclose(of_axes(scene, "step")[:, kept], expected[:, kept], atol=1e-13)


def test_masses_are_those_of_the_bodies_and_what_is_fixed_has_no_place(rng) -> None:
    scene, workspace, size, _ = begun(FRICTIONAL, rng)
    assert size == 3
    for p in range(size):
        own, i = workspace.mass[p], int(workspace.visited[p])
        inertia = scene.mass[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6]
        assert own.m == pytest.approx(scene.mass[6 * i, 6 * i], rel=1e-14)
        found = [[own.xx, own.xy, own.xz], [own.xy, own.yy, own.yz], [own.xz, own.yz, own.zz]]
        np.testing.assert_allclose(found, inertia, atol=1e-14)
    body_of = interpreted(minimise.make_body_of(FRICTIONAL))
    for contact in records(scene.contacts):
        for own, i in ((OF_A, contact.a), (OF_B, contact.b)):
            place = body_of(contact, workspace, own)
            assert (place == -1) if i == 0 else (workspace.visited[place] == i)


def test_a_round_that_is_at_its_minimum_makes_no_change(rng) -> None:
    """Impulses that answer their own velocities: the gradient is zero from the start."""
    scene, workspace, size, _ = begun(FRICTIONAL, rng)
    contacts = records(scene.contacts)
    for name in ("velocity_n", "velocity_1", "velocity_2"):
        scene.contacts[name] = 0.0
    scene.contacts["scale"] = 1.0
    before = stacked(scene.velocities)
    run = interpreted(minimise.make_minimise(FRICTIONAL))
    assert run(contacts, len(PAIRS), size, workspace, 0.0) == (1, True)
    assert not workspace.change.any()
    np.testing.assert_array_equal(stacked(scene.velocities), before)
