"""A kernel's file says what compiling it took, and whether its process had compiled others."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from small_configs import python, write

from tests.kept_kernels import of_scenes

# The smallest plan there is: what a plan holds changes nothing of what is noted of it.
FLIGHT = """\
scene:
  bodies: {ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}}
duration: 0.1
"""
# Compiles two plans, loads none or both: argv is config, then `anew` or `kept`.
COMPILE = """
import json, sys
from time import thread_time
from pathlib import Path
from lavendersim.engine.step import advance_for
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of
cell = load_experiment(Path(sys.argv[1])).cells()[0]
plan = plan_of(cell.config, record=False).spec
found = []
for spec in (plan, plan.including("rotation")):
    cache = advance_for(spec)._cache
    cache.anew = sys.argv[2] == "anew"
    start = thread_time()
    build(cell.config, spec).engine(spec).advance(0)
    spent = thread_time() - start
    took = cache.compiled()
    found.append([cache.hits, cache.misses, spent, *(took or ())])
print(json.dumps(found))
"""


def compiled(config: Path, how: str, kernels: Path) -> Any:
    return json.loads(python(COMPILE, config, how, LAVENDER_CACHE_DIR=str(kernels)))


def test_the_time_a_kernel_took_to_compile_is_kept_with_it(tmp_path: Path) -> None:
    config, kernels = write(tmp_path, FLIGHT), tmp_path / "kernels"
    first, second = compiled(config, "kept", kernels)
    for hits, misses, spent, seconds, _ in (first, second):
        assert (hits, misses) == (0, 1)
        # The engine's arrays are allocated, and the kernel is composed, outside of it.
        assert 0.5 * spent < seconds <= spent
    assert (first[4], second[4]) == (True, False)  # the second found parts of the first
    for loaded, made in zip(compiled(config, "kept", kernels), (first, second), strict=True):
        assert loaded[:2] == [1, 0]
        assert loaded[3:] == made[3:]  # what compiling took, not what loading takes
    for again in compiled(config, "anew", kernels):
        assert again[:2] == [0, 1]
        assert again[2] >= again[3]
    assert len(of_scenes(kernels)) == 2
