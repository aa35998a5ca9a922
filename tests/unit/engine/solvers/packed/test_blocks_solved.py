"""One packed update of a block is Coulomb's law at once where its response is diagonal."""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, plane, resolved, sphere
from packed_scenes import BLOCKS

from tests.benchmarks.prepared_contacts import Solve, next_step

MU, RADIUS, DT, G = 0.3, 0.1, 1.0 / 240.0, 9.81
SPEEDS = np.linspace(0.0, 0.2, 11)  # [m/s] of balls that do not spin


@pytest.mark.parametrize("solver", ["block_gauss_seidel", "coloured_gauss_seidel"])
def test_a_ball_on_a_plane_sticks_or_slides_after_one_sweep(solver: str) -> None:
    """A ball has K = diag(1, 7/2, 7/2) / m: lambda_n = m g dt; lambda_t = 2/7 m v where that is
    below mu lambda_n, else mu lambda_n; each against its slip. One visit, some ten roundings.
    """
    balls = {
        f"ball_{k}": sphere(
            RADIUS, (0.0, k, RADIUS), mass=1.0 + k, velocity=(v, 0.0, 0.0), friction=MU
        )
        for k, v in enumerate(SPEEDS)
    }
    bench = Bench(resolved({"floor": plane(friction=MU), **balls}, (0.0, 0.0, -G)))
    solve = Solve(next_step(bench.engine, BLOCKS), solver)
    solve.run(1)
    mass = 1.0 + np.arange(len(SPEEDS))
    expected = np.minimum(2.0 / 7.0 * SPEEDS, MU * G * DT)
    slides = 2.0 / 7.0 * SPEEDS > MU * G * DT
    assert 0 < np.count_nonzero(slides) < len(SPEEDS) - 1
    in_order = np.argsort(solve.contacts["b"])
    found = solve.impulses[in_order] / mass[:, None]
    np.testing.assert_allclose(found[:, 0], G * DT, rtol=1e-15 * 10)
    np.testing.assert_allclose(np.hypot(*found[:, 1:].T), expected, rtol=0, atol=1e-16)
    np.testing.assert_allclose(solve.velocities["vx"][1:], SPEEDS - expected, rtol=0, atol=2.0**-53)
