"""Packed sweeps obey the laws of torsional and rolling friction in closed form, 200 bodies at once.

No warm start: every solve is a long one, most of whose sweeps are packed.
"""

from __future__ import annotations

from math import cos, sin, tan

import numpy as np
import pytest
from laboratory import Bench, plane, planned, resolved, sphere
from packed_drawn import drawn, packed_solver, with_rows

from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS, FIRST
from tests.benchmarks.prepared_contacts import Solve

G, DT, RADIUS = 9.81, 1.0 / 240.0, 0.1
COUNT = 200
millions_of_sweeps = pytest.mark.usefixtures("optimised")


def laws_defects(solve: Solve, bodies: np.ndarray) -> np.ndarray:
    """Return |k psi - proj(k psi - omega)| times the arm [m/s] of torsion and rolling, by contact.

    From poses, inertias, normals and tangents; k: the response, of rolling its greatest.
    """
    defects = np.zeros((solve.count, 2))
    for row, contact in zip(defects, solve.contacts, strict=True):
        point, n, one, two = (
            np.array([contact[f"{axis}{x}"] for x in "xyz"]) for axis in ("", "n", "t1", "t2")
        )
        response, spin, arm = np.zeros((3, 3)), np.zeros(3), 0.0
        for sign, i in ((-1.0, contact["a"]), (1.0, contact["b"])):
            body = bodies[i]
            turn = np.array([[body[f"r{r}{c}"] for c in range(3)] for r in range(3)])
            response += turn @ np.diag([body[f"inv_i{x}"] for x in "xyz"]) @ turn.T
            spin += sign * np.array([solve.velocities[i][f"w{x}"] for x in "xyz"])
            if body["inv_m"] > 0.0:
                own = point + 0.5 * sign * contact["phi"] * n - [body[x] for x in "xyz"]
                arm = max(arm, float(np.linalg.norm(own)))
        across = np.stack([one, two])
        for k, (axes, psi, c) in enumerate(
            (
                (n[None], [contact["psi_n"]], contact["torsional"]),
                (across, [contact["psi_1"], contact["psi_2"]], contact["rolling"]),
            )
        ):
            stiff = np.linalg.eigvalsh(axes @ response @ axes.T)[-1]
            held, limit = stiff * np.array(psi), stiff * c * contact["lambda_n"]
            moved = held - axes @ spin
            size = np.linalg.norm(moved)
            row[k] = arm * np.linalg.norm(held - moved * (limit / size if size > limit else 1.0))
    return defects


@pytest.mark.parametrize("eight", [False, True])
def test_torques_come_to_their_laws_written_without_the_engine(eight: bool) -> None:
    """The residual of 2000 sweeps is below 1e-4 m/s; it is the largest defect of any law, so both
    of these are below it, and above a hundred times that before any sweep.
    """
    terms = ("frictional", "levers", "torsional", "rolling", "frictionless", "shifted")
    spec = with_rows(*terms).without("newton")._replace(shape_pairs=())
    prepared = drawn(1)._replace(spec=spec)
    solve = Solve(prepared, packed_solver(eight))
    solve.run(0)
    assert (laws_defects(solve, prepared.bodies).max(axis=0) > 1e-2).all()
    solve.run(2000)
    assert solve.residual < 1e-4
    assert laws_defects(solve, prepared.bodies).max() <= solve.residual * (1.0 + 1e-9)


def made(bodies: dict, gravity: tuple, steps: int) -> Bench:
    """Return an engine after so many steps, every one of which packed its contacts.

    One engine for all: a coefficient of zero leaves a torque at zero.
    """
    cell = resolved(bodies, gravity, solver="adaptive", sweeps=300, warm_start=False)
    cell["record"]["residuals"] = "none"
    plan = planned(cell)
    assert plan.decisions["packed_sweeps"].on
    spec = plan.spec.including("rolling_friction", "torsional_friction")
    bench = Bench(cell, spec._replace(shape_pairs=("sphere_plane", "sphere_sphere")))
    for _ in range(steps):
        bench.run(1)
        assert bench.engine.counters["contacts"][0] >= FEWEST_CONTACTS
        assert bench.engine.counters["sweeps"][0] > FIRST
    return bench


@millions_of_sweeps
def test_balls_that_spin_on_others_stop_by_torsional_friction() -> None:
    """Load m g on the upper contact, (M + m) g on the lower one, whose limit is the greater: the
    lower ball rests, and the upper one spins at omega_0 - c g t / (2/5 r^2) until it rests, too.
    30 steps of 1/240 s, each of some 300 sweeps with errors of round-off: 30 * 1e-13.
    """
    steps, c = 30, 2e-3
    loss = c * G * steps * DT / (0.4 * RADIUS**2)  # 0.6 rad/s
    spins = np.linspace(0.1, 3.0, COUNT // 2) * np.where(np.arange(COUNT // 2) % 2, 1.0, -1.0)
    bodies = {"floor": plane(friction=0.5)}
    for k, spin in enumerate(spins):
        place = (0.5 * k, 0.0, RADIUS)
        bodies[f"lower_{k}"] = sphere(RADIUS, place, mass=8.0, friction=0.5, torsional_friction=c)
        bodies[f"upper_{k}"] = sphere(
            RADIUS, (0.5 * k, 0.0, 3 * RADIUS), mass=1.0, friction=0.5,
            angular_velocity=(0.0, 0.0, spin),
        )  # fmt: skip
    bench = made(bodies, (0.0, 0.0, -G), steps)
    expected = np.sign(spins) * np.maximum(np.abs(spins) - loss, 0.0)
    assert 0 < np.count_nonzero(expected) < COUNT // 2
    turning = bench.spin[1:].reshape(COUNT // 2, 2, 3)
    np.testing.assert_allclose(turning[:, 1, 2], expected, rtol=0, atol=3e-12)
    np.testing.assert_allclose(turning[:, 0], 0.0, rtol=0, atol=3e-12)
    np.testing.assert_allclose(bench.velocity, 0.0, rtol=0, atol=3e-12)


@millions_of_sweeps
def test_balls_rest_on_a_slope_below_their_angle_of_rolling_and_roll_above_it() -> None:
    """A ball rests up to tan(angle) = c / r; above it rolls, without sliding, at
        a = (g sin(angle) - c / r g cos(angle)) / (1 + 2/5)
    Friction and rolling friction of a contact are two blocks that share 2.5/3.5 of their response:
    0.71 of the error stays a sweep, 0.71^300 is below round-off. 30 steps of it: 30 * 1e-13.
    """
    steps, angle = 30, 0.1
    lengths = np.linspace(0.1, 2.0, COUNT) * RADIUS * tan(angle)
    bodies = {"slope": plane(friction=0.8)}
    for k, c in enumerate(lengths):
        bodies[f"ball_{k}"] = sphere(
            RADIUS, (0.0, 0.5 * k, RADIUS), mass=0.5 + 0.01 * k, friction=0.8,
            rolling_friction=float(c),
        )  # fmt: skip
    bench = made(bodies, (G * sin(angle), 0.0, -G * cos(angle)), steps)
    pull = np.maximum(G * sin(angle) - lengths / RADIUS * G * cos(angle), 0.0)
    expected = pull / 1.4 * steps * DT
    assert COUNT // 3 < np.count_nonzero(expected) < 2 * COUNT // 3
    np.testing.assert_allclose(bench.velocity[1:, 0], expected, rtol=0, atol=3e-12)
    np.testing.assert_allclose(bench.spin[1:, 1], expected / RADIUS, rtol=0, atol=3e-11)
    np.testing.assert_allclose(bench.velocity[1:, 1:], 0.0, rtol=0, atol=3e-12)
