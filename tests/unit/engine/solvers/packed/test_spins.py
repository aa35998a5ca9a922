"""Packed sweeps obey the laws of torsional and rolling friction in closed form, 300 bodies at once.

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
COUNT = 300


def made(bodies: dict, gravity: tuple, steps: int) -> Bench:
    """Return an engine after so many steps, every one of which packed its contacts."""
    cell = resolved(bodies, gravity, solver="adaptive", sweeps=300, warm_start=False)
    plan = planned(cell)
    assert plan.decisions["packed_sweeps"].on
    bench = Bench(cell, plan.spec)
    for _ in range(steps):
        bench.run(1)
        assert bench.engine.counters["contacts"][0] >= FEWEST_CONTACTS
        assert bench.engine.counters["sweeps"][0] > FIRST
    return bench


def test_balls_that_spin_on_others_stop_by_torsional_friction() -> None:
    """Load m g on the upper contact, (M + m) g on the lower one, whose limit is the greater: the
    lower ball rests, and the upper one spins at omega_0 - c g t / (2/5 r^2) until it rests, too.
    60 steps of 1/240 s, each of some 300 sweeps with errors of round-off: 60 * 1e-13.
    """
    steps, c = 60, 2e-3
    loss = c * G * steps * DT / (0.4 * RADIUS**2)  # 1.2 rad/s
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
    np.testing.assert_allclose(turning[:, 1, 2], expected, rtol=0, atol=6e-12)
    np.testing.assert_allclose(turning[:, 0], 0.0, rtol=0, atol=6e-12)
    np.testing.assert_allclose(bench.velocity, 0.0, rtol=0, atol=6e-12)


def test_balls_rest_on_a_slope_below_their_angle_of_rolling_and_roll_above_it() -> None:
    """A ball rests up to tan(angle) = c / r; above it rolls, without sliding, at
        a = (g sin(angle) - c / r g cos(angle)) / (1 + 2/5)
    Friction and rolling friction of a contact are two blocks that share 2.5/3.5 of their response:
    0.71 of the error stays a sweep, 0.71^300 is below round-off. 60 steps of it: 60 * 1e-13.
    """
    steps, angle = 60, 0.1
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
    assert 100 < np.count_nonzero(expected) < 200
    np.testing.assert_allclose(bench.velocity[1:, 0], expected, rtol=0, atol=6e-12)
    np.testing.assert_allclose(bench.spin[1:, 1], expected / RADIUS, rtol=0, atol=6e-11)
    np.testing.assert_allclose(bench.velocity[1:, 1:], 0.0, rtol=0, atol=6e-12)


@pytest.mark.parametrize("eight", [False, True])
def test_solved_torques_are_their_laws_fixed_points(eight: bool) -> None:
    """After many sweeps each psi is what its law asks for at the velocities there are: none beyond
    c lambda_n, on that limit against the spin where there is one. Written without `spin_block`.
    """
    terms = ("frictional", "levers", "torsional", "rolling", "frictionless", "shifted")
    spec = with_rows(*terms).without("newton")._replace(shape_pairs=())
    solve = Solve(drawn(1)._replace(spec=spec), packed_solver(eight))
    solve.run(2000)
    assert solve.residual < 1e-10
    contacts, w = solve.contacts, np.stack([solve.velocities[f"w{x}"] for x in "xyz"], axis=1)
    relative = w[contacts["b"].astype(int)] - w[contacts["a"].astype(int)]
    about = [
        np.sum(relative * np.stack([contacts[f"{axis}{x}"] for x in "xyz"], axis=1), axis=1)
        for axis in ("n", "t1", "t2")
    ]
    slow = 1e-8  # [rad/s] above what the residual allows at an arm of 0.1 m
    for psi, spin, c in (
        (contacts["psi_n"][:, None], about[0][:, None], contacts["torsional"]),
        (
            np.stack([contacts["psi_1"], contacts["psi_2"]], axis=1),
            np.stack(about[1:], axis=1),
            contacts["rolling"],
        ),
    ):
        limit, size = c * contacts["lambda_n"], np.linalg.norm(psi, axis=1)
        assert (size <= limit * (1.0 + 1e-15)).all()
        speed = np.linalg.norm(spin, axis=1)
        turns = (limit > 0.0) & (speed > slow)
        assert np.count_nonzero(turns) > 5
        assert np.count_nonzero((limit > 0.0) & ~turns) > 5
        opposed = -spin[turns] / speed[turns][:, None] * limit[turns][:, None]
        # The residual bounds the angle between them by 1e-10 / (0.1 m speed).
        np.testing.assert_allclose(psi[turns], opposed, rtol=0, atol=0.2 * limit.max())
        share = np.linalg.norm(psi[turns] - opposed, axis=1) * speed[turns] / limit[turns]
        assert share.max() < slow
