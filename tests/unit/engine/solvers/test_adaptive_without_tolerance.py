"""`adaptive` without a tolerance: as with one that no solve reaches, Newton's cost weighed alike.

The number of sweeps that a tolerance still needs is taken of its logarithm. A heap of cold balls
under heavy ones converges so slowly that Newton's method is asked in every step, and has so many
contacts that what its steps cost decides how many are taken.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from laboratory import Bench, plane, planned, resolved, sphere

SIDE = 3  # balls along each edge of the heap
STEPS, SWEEPS = 6, 50
UNREACHED = 1e-300  # [m/s] far below the smallest difference of two speeds of 1 m/s


def heap(**numerics: Any) -> dict[str, Any]:
    bodies = {"floor": plane(friction=0.5)}
    for i in range(SIDE):
        for j in range(SIDE):
            for k in range(SIDE):
                place = (0.2 * i + 0.001 * k, 0.2 * j + 0.0013 * k, 0.1 + 0.1999 * k)
                mass = 30.0 if k == SIDE - 1 else 1.0
                bodies[f"ball_{i}{j}{k}"] = sphere(0.1, place, friction=0.5, mass=mass)
    return resolved(bodies, (0.0, 0.0, -9.81), solver="adaptive", sweeps=SWEEPS, **numerics)


def run(tolerance: float | None) -> tuple[np.ndarray, int]:
    """Return the rows of steps and how many steps of Newton's method were taken in all."""
    cell = heap(tolerance=None, warm_start=False)
    bench = Bench(cell, planned(cell).spec)
    if tolerance is not None:
        bench.engine.parameters["tolerance"] = tolerance
    rows = bench.run(STEPS).step
    return rows, int(bench.engine.counters["newton_steps"][0])


@pytest.fixture(scope="module")
def without() -> tuple[np.ndarray, int]:
    return run(None)


def test_no_tolerance_is_as_one_that_is_never_reached(without: tuple[np.ndarray, int]) -> None:
    rows, newton_steps = run(UNREACHED)
    assert newton_steps > STEPS  # it is asked
    assert without[1] == newton_steps
    np.testing.assert_array_equal(without[0]["state_hash"], rows["state_hash"])


def test_without_a_tolerance_no_solve_stops_early(without: tuple[np.ndarray, int]) -> None:
    rows, _ = without
    assert (rows["residual"][1:] > 0.0).all()  # a sweep would still change something
    assert (rows["sweeps"][1:] == SWEEPS).all()
    assert not rows["not_converged"].any() if "not_converged" in rows.dtype.names else True
