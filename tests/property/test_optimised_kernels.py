"""Optimised kernels give the bits of those that are not: what the suite compiles stands for both.

Neither numba nor LLVM is allowed to reorder or to contract (`compile_options.OPTIONS`). Spheres of
the scene strike, turn and slide; contacts are swept eight at a time, by vectors.

The optimised kernels are those of the scene's own plan. The others are those by which the suite
runs the scene, so that they are compiled once: a family's, where what the scene has no use for is
idle, and changes no bit either (tests/composition).
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
RUN = """
import hashlib, os, sys
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
from numba import config
from tests.families_of_plans import spec_of_family

def made(spec):
    return build(cell.config, spec).engine(spec)

cell = load_experiment(sys.argv[1]).cells()[0]
plan = plan_of_cell(cell)
own, is_own = made(plan.spec), config.OPT or "LAVENDER_TEST_EVERYTHING" in os.environ
spec = plan.spec if is_own else spec_of_family(plan)
engine = made(spec)
engine.advance(int(sys.argv[2]))
assert engine.counters["step"][0] > 0
states = hashlib.sha256()
tables = [(engine.bodies, own.bodies), (engine.velocities, own.velocities)]
for found, columns in [*tables, (engine.take_rows().step, own.take_rows().step)]:
    for name in columns.dtype.names:
        states.update(found[name].tobytes())
print(int(config.OPT), spec.has("packed_sweeps"))
print(states.hexdigest())
"""


def states(config: str, steps: int, optimised: int) -> list[str]:
    """Return the level, whether contacts are packed, and the hash of the states."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, str(ROOT / "configs" / config), str(steps)],
        env=os.environ | {"NUMBA_OPT": str(optimised)},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_optimised_kernels_give_the_same_bits() -> None:
    (plain, one), (optimised, other) = (states("scenes/pile.yaml", 40, level) for level in (0, 3))
    assert (plain, optimised) == ("0 True", "3 True")
    assert one == other
