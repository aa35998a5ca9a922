"""Engines whose solver packs its contacts do mechanics, and lanes need no processor of a kind."""

from __future__ import annotations

import hashlib
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
from laboratory import Bench, box, plane, planned, resolved, sphere
from packed_scenes import found

from lavendersim.engine.solvers.packed.late import FEWEST_CONTACTS
from tests.benchmarks.prepared_contacts import Solve

ROOT = Path(__file__).parents[4]
SPEEDS = np.linspace(0.5, 2.0, 13)  # [m/s] of so many balls: two groups of eight
REMOTE = """
import hashlib, pickle, sys
from tests.benchmarks.prepared_contacts import Solve
solve = Solve(pickle.loads(open(sys.argv[1], "rb").read()), "coloured_gauss_seidel")
solve.run(20)
print(hashlib.sha256(solve.impulses.tobytes() + solve.velocities.tobytes()).hexdigest())
"""


def test_balls_that_slide_end_up_rolling_at_five_sevenths_of_their_speed() -> None:
    """Friction acts on the floor: a ball's angular momentum about it stays, m v R + 2/5 m R^2 w.
    The last of sliding is gone after 2 v / (7 mu g) = 0.2 s. Some 240 steps of round-off.
    """
    hashes = {}
    for solver in ("block_gauss_seidel", "coloured_gauss_seidel"):
        balls = {
            f"ball_{k}": sphere(0.1, (0.0, k, 0.1), velocity=(v, 0.0, 0.0), friction=0.3)
            for k, v in enumerate(SPEEDS)
        }
        bodies = {"floor": plane(friction=0.3), **balls}
        bench = Bench(resolved(bodies, (0.0, 0.0, -9.81), solver=solver), spec=None)
        rows = bench.run(240)
        assert bench.spec.solver == solver
        np.testing.assert_allclose(bench.velocity[1:, 0], 5.0 / 7.0 * SPEEDS, rtol=0, atol=1e-12)
        np.testing.assert_allclose(bench.spin[1:, 1], 50.0 / 7.0 * SPEEDS, rtol=0, atol=1e-11)
        hashes[solver] = rows.step["state_hash"].tolist()
    assert hashes["block_gauss_seidel"] == hashes["coloured_gauss_seidel"]


def test_a_processor_without_wide_vectors_gives_the_same_bits(tmp_path: Path) -> None:
    """LLVM splits eight lanes into what there is: machine code for any processor of this kind."""
    prepared = found("mixed")
    solve = Solve(prepared, "coloured_gauss_seidel")
    solve.run(20)
    here = hashlib.sha256(solve.impulses.tobytes() + solve.velocities.tobytes()).hexdigest()
    handed = tmp_path / "prepared"
    handed.write_bytes(pickle.dumps(prepared))
    done = subprocess.run(
        [sys.executable, "-c", REMOTE, str(handed)],
        cwd=ROOT,
        env={**os.environ, "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.stdout.strip() == here, done.stderr


def _settled(packs: bool) -> Bench:
    """Return an engine of walls of boxes on a floor after half a second of the default numerics."""
    bodies = {"floor": plane(friction=0.5)}
    for k in range(12):
        for row in range(4):
            bodies[f"box_{k}_{row}"] = box(
                (0.2, 0.2, 0.2), (0.21 * k, 0.0, 0.1 + 0.2 * row), mass=1.0 + row, friction=0.5
            )
    bodies["heavy"] = box((2.4, 0.2, 0.2), (1.155, 0.0, 0.9), mass=100.0, friction=0.5)
    cell = resolved(
        bodies, (0.0, 0.0, -9.81), solver="adaptive", sweeps=50, tolerance=1e-9, slop=1e-4
    )
    spec = planned(cell).spec.without("packed_sweeps")
    bench = Bench(cell, spec.including("packed_sweeps") if packs else spec)
    bench.run(120)
    return bench


def test_newtons_method_finishes_what_packed_sweeps_begin_and_runs_are_equal() -> None:
    """A load of 100 kg on towers of 4 kg at most: no 50 sweeps carry it through to 1e-9 m/s."""
    packed, again, records = _settled(True), _settled(True), _settled(False)
    for bench in (packed, records):
        counters = bench.engine.counters[0]
        assert counters["contacts"] >= FEWEST_CONTACTS
        assert counters["newton_steps"] > 0
        assert counters["residual"] <= 1e-9
        assert np.abs(bench.velocity).max() < 1e-8  # at rest
    assert packed.engine.bodies.tobytes() == again.engine.bodies.tobytes()
    assert packed.engine.velocities.tobytes() == again.engine.velocities.tobytes()
    # Both stop within 1e-9 m/s of the solution in each of 120 steps of 1/240 s; positional
    # projection goes on from there: 1 um is a thousandth of the slop's hundredth part.
    for axis in "xyz":
        np.testing.assert_allclose(
            packed.engine.bodies[axis], records.engine.bodies[axis], rtol=0, atol=1e-6
        )
