"""Of all impulses with the same effect those of least norm, by dense algebra and by trying faces.

Bodies at rest, impulses anywhere on their cones: the laws hold whatever they are.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from drawn_contacts import Drawn, drawn, stacked
from interpreted import interpreted, records

from lavendersim.engine.memory import allocate_counters
from lavendersim.engine.solvers.newton.envelope import allocate_envelope, lay_out
from lavendersim.engine.solvers.newton.faces import STICKS, make_face_stiffness
from lavendersim.engine.solvers.newton.least_norm import make_begin, make_least_norm
from lavendersim.engine.solvers.newton.minimise import make_assemble_mass
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

FRICTIONAL = Spec(effects=("friction", "least_norm", "newton", "rotation"), solver="adaptive")
FRICTIONLESS = Spec(
    effects=("contact_torque", "least_norm", "newton", "rotation"), solver="adaptive"
)
# Impulses are right to the shares at which rounds end and friction is exact, times what few
# contacts amplify.
ALLOWED = 1e-9


def upright(rng: np.random.Generator) -> np.ndarray:
    return np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def at_rest(spec: Spec, rng: np.random.Generator, count: int) -> Drawn:
    """Return a body on a floor at `count` points, where nothing moves and all carry."""
    scene = drawn(spec, rng, [(0, 1)] * count, frame_of=upright)
    for name in ("vx", "vy", "vz", "wx", "wy", "wz"):
        scene.velocities[name] = 0.0
    scene.contacts["target"] = 0.0
    scene.contacts["lambda_n"] = rng.uniform(0.5, 2.0, count)
    return scene


def impulses(scene: Drawn) -> np.ndarray:
    names = [n for n in ("lambda_n", "lambda_1", "lambda_2") if n in scene.contacts.dtype.names]
    return np.stack([scene.contacts[name] for name in names], axis=1)


def chosen(spec: Spec, scene: Drawn, counters: np.ndarray | None = None) -> np.ndarray:
    """Return the impulses that the kernel chooses."""
    count = len(scene.contacts)
    if counters is None:
        counters = allocate_counters()
        counters["unchosen"] = 1.0
    bodies, velocities, contacts = (
        records(rows) for rows in (scene.bodies, scene.velocities, scene.contacts)
    )
    system = ContactSystem(contacts, np.arange(count), count, bodies, velocities)
    workspace = records(allocate_envelope(len(bodies), count, 2000))
    interpreted(make_least_norm(spec))(system, workspace, None, records(counters)[0])
    return impulses(scene)


def test_impulses_are_the_pseudoinverse_s_where_all_cones_allow_it(rng) -> None:
    scene = at_rest(FRICTIONAL, rng, 5)
    scene.contacts["mu"] = 10.0
    jacobian = scene.jacobian[:, 6:]
    before = impulses(scene).ravel()
    expected = np.linalg.lstsq(jacobian.T, jacobian.T @ before, rcond=None)[0]
    assert (expected[::3] > 0.05).all()
    assert np.abs(expected - before).max() > 0.1
    found = chosen(FRICTIONAL, scene).ravel()
    np.testing.assert_allclose(found, expected, atol=ALLOWED)
    # Nothing of it is seen by the body.
    np.testing.assert_allclose(stacked(scene.velocities), 0.0, atol=ALLOWED)


def test_the_first_step_is_the_dense_one_of_contacts_that_all_carry(rng) -> None:
    """(M + E J^T J) dv = -J^T lambda*: what dampers E answer, less what the solve had."""
    scene, stiff, load = at_rest(FRICTIONAL, rng, 5), 1e3, 1.0
    for axis in "n12":
        scene.contacts[f"start_{axis}"] = scene.contacts[f"lambda_{axis}"]
    scene.contacts["face"], scene.contacts["mu"] = STICKS, 10.0
    bodies, contacts = records(scene.bodies), records(scene.contacts)
    workspace = records(allocate_envelope(2, 5, 2000))
    size, _, _ = interpreted(lay_out)(contacts, 5, workspace)
    interpreted(make_assemble_mass(FRICTIONAL))(bodies, size, workspace)
    begin = interpreted(make_begin(FRICTIONAL, make_face_stiffness(FRICTIONAL)))
    slope = begin(contacts, 5, size, workspace, stiff, load)
    jacobian, mass = scene.jacobian[:, 6:], scene.mass[6:, 6:]
    gradient = jacobian.T @ impulses(scene).ravel()
    change = np.linalg.solve(mass + stiff * jacobian.T @ jacobian, -gradient)
    np.testing.assert_allclose(workspace.change[:6], change, atol=1e-13)
    assert slope == pytest.approx(change @ gradient, rel=1e-11)
    velocity = np.stack([scene.contacts[f"velocity_{axis}"] for axis in "n12"], axis=1)
    expected = impulses(scene) / stiff + (jacobian @ change).reshape(-1, 3)
    np.testing.assert_allclose(velocity, expected, atol=1e-13)


def least_of_faces(normals: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Return the least x >= 0 with normals^T x = load, of every choice of rows that carry."""
    best = None
    for carries in product((True, False), repeat=len(normals)):
        own = np.flatnonzero(carries)
        if not len(own):
            continue
        x = np.zeros(len(normals))
        x[own] = np.linalg.lstsq(normals[own].T, load, rcond=None)[0]
        if np.abs(normals.T @ x - load).max() < 1e-11 and x.min() >= -1e-14:
            best = x if best is None or x @ x < best @ best else best
    assert best is not None
    return best


def test_no_normal_pulls_where_the_pseudoinverse_would_pull(rng) -> None:
    """Six legs under a load beside them: who would pull is open, the others carry."""
    pulls = 0
    for _ in range(6):
        scene = at_rest(FRICTIONLESS, rng, 6)
        scene.contacts["lambda_n"] = [2.0, 0.1, 0.0, 0.0, 0.1, 0.0]
        normals = scene.jacobian[::3, 6:]
        load = normals.T @ scene.contacts["lambda_n"]
        free = np.linalg.lstsq(normals.T, load, rcond=None)[0]
        pulls += free.min() < -1e-3
        expected = least_of_faces(normals, load)
        found = chosen(FRICTIONLESS, scene)[:, 0]
        np.testing.assert_allclose(found, expected, atol=ALLOWED)
    assert pulls >= 2


def test_equal_legs_of_a_table_carry_alike(rng) -> None:
    scene = at_rest(FRICTIONLESS, rng, 4)
    for row, (x, y) in zip(scene.contacts, [(1, 1), (-1, 1), (-1, -1), (1, -1)], strict=True):
        row["lever_bx"], row["lever_by"], row["lever_bz"] = y, -x, 0.0
        lever = [row["lever_bx"], row["lever_by"], 0.0]
        row["turn_bx"], row["turn_by"], row["turn_bz"] = scene.inverse[9:, 9:] @ lever
    scene.contacts["lambda_n"] = [2.0, 0.0, 2.0, 0.0]
    np.testing.assert_allclose(chosen(FRICTIONLESS, scene)[:, 0], 1.0, atol=ALLOWED)


@pytest.mark.parametrize("why", ["hardly changed", "nothing carries", "as many as bodies"])
def test_impulses_stay_where_there_is_nothing_to_choose(why: str, rng) -> None:
    scene, counters = at_rest(FRICTIONLESS, rng, 1 if why == "as many as bodies" else 4), None
    if why == "hardly changed":
        counters = allocate_counters()
        counters["chosen"], counters["unchosen"] = 1.0, 1e-7
    if why == "nothing carries":
        scene.contacts["lambda_n"] = 0.0
    before = impulses(scene)
    np.testing.assert_array_equal(chosen(FRICTIONLESS, scene, counters), before)


def test_impulses_stay_where_another_choice_would_break_a_law(rng) -> None:
    """Torques of contacts follow normal impulses: with a limit on them nothing is chosen."""
    spec = FRICTIONAL.including("torsional_friction")
    scene = at_rest(spec, rng, 5)
    scene.contacts["torsional"] = 0.01
    before = impulses(scene)
    np.testing.assert_array_equal(chosen(spec, scene), before)
