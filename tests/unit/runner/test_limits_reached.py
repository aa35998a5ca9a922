"""What ran out of iterations stands in the log, the results, and in what `run` and `show` print."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from lavendersim.runner import open_run
from lavendersim.runner.accuracy import Accuracy
from lavendersim.runner.limits_reached import AT_LIMIT, limits_in_words
from lavendersim.trace.schema import STEP_COLUMNS
from tests.forked_python import python

# Stands, or is thrown down, spins, and hangs on a spring: every search has something to do.
LOG = """\
scene:
  gravity: [0, 0, -9.81]
  bodies:
    floor: {shape: {kind: box, size: [2, 2, 0.2]}, fixed: true, position: [0, 0, -0.1]}
    log:
      shape: {kind: cylinder, radius: 0.1, length: 0.3}
      mass: 1
      position: [0, 0, %s]
      velocity: [0.2, 0.1, %s]
      angular_velocity: [0.5, 1, 0.2]
  springs: [{a: floor, b: log, point_b: [0, 0.1, 0], stiffness: 50, damping: 1, rest_length: 0.2}]
numerics: {timestep: 1/240}
duration: 0.05
"""
STANDS, THROWN = LOG % (0.149, 0), LOG % (0.4, -20)
# In another process: kernels of this one have the budget that they were made with.
BUDGET = """
import sys
from lavendersim.engine import impact_location, midpoint_passes, spring_midpoint
from lavendersim.engine.collide import swept
from lavendersim.engine.collide.convex import separation
from lavendersim.engine.solvers.newton import least_norm
separation.ASCENTS = least_norm.ROUNDS = 1
midpoint_passes.PASSES = midpoint_passes.MOST_PASSES = 1
swept.ADVANCES = impact_location.PASSES = spring_midpoint.PASSES = 2
"""
STARVES = {f"{name}_not_converged" for name in ("ascent", "midpoint", "spring")}
ASKED = STARVES | {
    f"{name}_not_converged" for name in ("gjk", "epa", "advance", "impact", "gyroscopic")
}
STARVED = f"""{BUDGET}
from lavender_cli.main import main
sys.argv = ["lavender", *sys.argv[1:]]
main()
"""
# With room for two contacts in the log the first step, which has four, is begun again.
IN_BLOCKS = """
import json
from lavendersim import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
experiment = load_experiment("log.yaml")
cell = experiment.cells()[0]
config = cell.config
plan = plan_of_cell(cell)
table = []
for block in (1, 5, 1000):
    engine = build(config, plan.spec).engine(plan.spec, block)
    if block == 5:
        engine.log = engine.log._replace(contact=engine.log.contact[:2])
    engine.advance(0)
    engine.workspace.collision.not_converged[["gjk", "epa"]] = (3, 2)
    counts = []
    while engine.counters["step"][0] < config.steps:
        engine.advance(config.steps - int(engine.counters["step"][0]))
        rows = engine.take_rows().step
        counts += [[int(row["gjk_not_converged"]), int(row["epa_not_converged"])] for row in rows]
    is_grown = block == 5 and len(engine.log.contact) > 2
    table.append([is_grown, counts])
print(json.dumps(table))
"""


def lavender(program: list[str], *words: str, where: Path) -> subprocess.CompletedProcess[str]:
    return python(*program, *words, where=where)


def test_counts_are_columns_of_the_log() -> None:
    assert set(AT_LIMIT) < {column.name for column in STEP_COLUMNS}


def test_counts_in_words() -> None:
    assert limits_in_words({}) == ""
    counts = {"gjk_not_converged": 3, "stronge_not_converged": 1}
    sentence = "3 distances of convex bodies by GJK, 1 impacts by Stronge's law did not converge"
    assert limits_in_words(counts) == sentence


def test_counts_of_blocks_of_steps_add_up() -> None:
    step = np.zeros(4, [("residual", "f8"), ("gjk_not_converged", "i8")])
    accuracy = Accuracy().after(step)
    assert accuracy.at_limit == {}
    step["gjk_not_converged"] = [0, 2, 0, 1]
    assert accuracy.after(step).after(step).at_limit == {"gjk_not_converged": 6}


def test_a_step_that_is_begun_again_forgets_what_it_counted(tmp_path: Path) -> None:
    (tmp_path / "log.yaml").write_text(STANDS)
    done = lavender(["-c", IN_BLOCKS], where=tmp_path)
    single, five, all_at_once = json.loads(done.stdout)
    assert (single[0], five[0], all_at_once[0]) == (False, True, False)
    none = [[0, 0]] * 11
    assert single[1] == all_at_once[1] == [[0, 0], [3, 2], *none]
    assert five[1] == [[0, 0], [0, 0], *none]


@pytest.mark.parametrize("starved", [False, True])
def test_a_run_says_how_often_they_ran_out(tmp_path: Path, starved: bool) -> None:
    (tmp_path / "log.yaml").write_text(THROWN)
    program = ["-c", STARVED] if starved else ["-m", "lavender_cli.main"]
    done = lavender(program, "run", "log.yaml", where=tmp_path)
    run = open_run(None, tmp_path / "runs")
    step = run.cells[0].trace().step
    counts = {name: int(step[name].sum()) for name in AT_LIMIT if name in step.dtype.names}
    assert set(counts) == ASKED
    (row,) = json.loads((run.path / "results.json").read_text())["cells"]
    shown = lavender(["-m", "lavender_cli.main"], "show", where=tmp_path).stdout
    found = {name: count for name, count in counts.items() if count}
    assert run.results().cells[0].at_limit == found
    assert {name: row[name] for name in AT_LIMIT if name in row} == found
    if starved:
        assert all(counts[name] > 0 for name in STARVES)
        assert f"log: {limits_in_words(found)}" in done.stderr
        assert limits_in_words(found) in shown
    else:
        assert found == {}
        assert "did not converge" not in done.stderr + shown
