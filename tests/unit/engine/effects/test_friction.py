"""What the laws that are there for study do to what slides and what sticks, by closed forms.

Convex relaxation: friction comes with lifting, w_n = mu |w_t|. A block that slides with
v and touches with its whole face does not turn: all its corners have one velocity, and
    m (v_x - v) = -mu P,    m (v_z + g dt) = P,    v_z = mu v_x
    v_x = (v - mu g dt) / (1 + mu^2)
Coulomb's law leaves v_x = v - mu g dt and v_z = 0. What a ball does, under the pyramid too, is
checked by `configs/scenes/friction_laws.yaml`.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from drawn_contacts import put_vector, random_frame
from interpreted import interpreted, records
from laboratory import Bench, box, plane, planned, resolved

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.engine.effects.friction import make_refresh
from lavendersim.engine.record_layout import allocate_bodies, allocate_velocities
from lavendersim.engine.spec import Spec
from lavendersim.problems.by_kernel import solve_by_kernel
from lavendersim.problems.residual import contact_velocities

G, DT, MU = 9.81, 1.0 / 240.0, 0.5
SPEED = 1.0
TOLERANCE = 1e-11
LIFTED = (SPEED - MU * G * DT) / (1.0 + MU * MU)
# A residual of so much in each of four corners, over the least eigenvalue of their W, some 0.1 of
# its diagonal where they are redundant.
ALLOWED = 100 * TOLERANCE


def block(cone: str, velocity: Any = (0.0, 0.0, 0.0), slope: float = 0.0) -> Bench:
    """A flat block on a plane, to be solved to the end."""
    angle = np.arctan(slope)
    bodies = {
        "floor": plane(friction=MU),
        "block": box((0.6, 0.6, 0.1), (0.0, 0.0, 0.05), velocity=velocity, friction=MU),
    }
    gravity = (G * np.sin(angle), 0.0, -G * np.cos(angle))
    numerics = {"sweeps": 20_000, "tolerance": TOLERANCE, "friction_cone": cone}
    cell = resolved(bodies, gravity, **numerics)
    cell["record"] = {"residuals": "none", "problems": "every 1"}
    return Bench(cell, planned(cell).spec)


@cache
def slid(cone: str) -> tuple[Bench, Any]:
    bench = block(cone, (SPEED, 0.0, 0.0))
    return bench, bench.run(1)


def test_the_convex_relaxation_lifts_what_slides() -> None:
    bench, rows = slid("convex")
    assert rows.step["not_converged"][-1] == 0
    np.testing.assert_allclose(bench.velocity[1], [LIFTED, 0.0, MU * LIFTED], atol=ALLOWED)
    np.testing.assert_allclose(bench.spin[1], 0.0, atol=ALLOWED / 0.05)


def test_coulombs_law_does_not() -> None:
    bench, rows = slid("disc")
    assert rows.step["not_converged"][-1] == 0
    np.testing.assert_allclose(bench.velocity[1], [SPEED - MU * G * DT, 0.0, 0.0], atol=ALLOWED)


def test_the_relaxations_error_is_the_models_and_not_the_solvers() -> None:
    """Solved to its end, it pushes contacts that open: Signorini's law, by all that they open."""
    _, rows = slid("convex")
    step = rows.step[-1]
    assert step["residual"] <= TOLERANCE
    assert step["signorini"] == pytest.approx(MU * LIFTED, abs=ALLOWED)
    # friction is as large as it may be, and against the motion
    assert step["cone"] <= 1e-15
    assert step["dissipation"] <= ALLOWED
    _, rows = slid("disc")
    for part in ("signorini", "dissipation"):
        assert rows.step[-1][part] <= ALLOWED


def test_what_sticks_sticks_under_both() -> None:
    for cone in ("convex", "disc"):
        bench = block(cone, slope=0.4)
        rows = bench.run(3)
        assert (rows.step["not_converged"][1:] == 0).all()
        np.testing.assert_allclose(bench.velocity[1], 0.0, atol=3 * ALLOWED)
        pull = np.hypot(rows.contact["impulse_t1"], rows.contact["impulse_t2"])
        last = rows.contact["step"] == 3
        slope = 0.4 / np.hypot(1.0, 0.4)
        assert rows.contact["impulse_n"][last].sum() == pytest.approx(G * DT * slope / 0.4)
        assert pull[last].sum() >= G * DT * slope * (1.0 - 1e-9)


@pytest.mark.parametrize("solver", ["projected_gauss_seidel", "jacobi"])
def test_a_solver_by_itself_finds_the_same_velocities(solver: str) -> None:
    bench, _ = slid("convex")
    found = bench.engine.problem()
    assert found is not None
    problem: ContactProblem = found.problem
    made = solve_by_kernel(solver, problem, 1e-12, 200_000, friction_cone="convex")
    u = contact_velocities(problem, made.impulses)
    np.testing.assert_allclose(u[:, 0], MU * LIFTED, atol=ALLOWED)
    np.testing.assert_allclose(np.linalg.norm(u[:, 1:], axis=1), LIFTED, atol=ALLOWED)


def test_world_inertias_are_those_of_the_body_turned_with_it(rng) -> None:
    """R diag R^T, and exactly diag where all moments are one."""
    spec = Spec(("contact_torque", "friction", "rotation"))
    bodies, velocities = allocate_bodies(spec, 4), allocate_velocities(spec, 4)
    turns, moments = [random_frame(rng) for _ in bodies], rng.uniform(0.2, 2.0, (4, 3))
    moments[3] = 0.7
    for body, turn, own in zip(bodies, turns, moments, strict=True):
        put_vector(body, "inv_i", own)
        for i in range(3):
            for j in range(3):
                body[f"r{i}{j}"] = turn[i, j]
    interpreted(make_refresh(spec))(records(bodies), records(velocities))
    for v, turn, own in zip(velocities, turns, moments, strict=True):
        found = [[v["j" + "".join(sorted(i + j))] for j in "xyz"] for i in "xyz"]
        np.testing.assert_allclose(found, turn @ np.diag(own) @ turn.T, atol=1e-15)
    assert [velocities[f"j{axis}"][3] for axis in ("xx", "yy", "zz", "xy")] == [0.7, 0.7, 0.7, 0.0]
