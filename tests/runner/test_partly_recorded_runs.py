"""A run that records contacts and poses of some steps is the same run, with less in its log."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from lavender_cli.main import app
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.figures.thumbnail import thumbnail
from lavendersim.measures import outcomes_of
from lavendersim.replay import save
from lavendersim.runner import Finished, run
from lavendersim.runner.log_size import expected_log_sizes
from lavendersim.runner.plans import shared_plans

# Three bricks fall on each other, are hit from above at 0.3 s, and come to rest.
SCENE = """\
scene:
  surfaces: {frictional: {friction: 0.5}}
  bodies:
    floor: {shape: {kind: plane}, surface: frictional}
  arrangements:
    brick:
      kind: tower
      count: 3
      gap: 0.05
      body: {shape: {kind: box, size: [0.3, 0.2, 0.1]}, mass: 1.0, surface: frictional}
duration: 1.0
always: {energy: none, penetration: none, impulses: none, momentum: none}
measure:
  momentum: {kind: momentum_drift}
  residual: {kind: law_violation, part: natural_map}
"""
RECORD = "record: {contacts: every 8, poses: {from: 0.25, to: 0.5}}\n"
CONTACTS = np.arange(0, 241, 8)  # 240 steps a second
POSES = np.arange(60, 121)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Finished, Finished]:
    """The run with every step recorded, and with some."""
    folder = tmp_path_factory.mktemp("runs")
    whole = run(load_experiment_text(SCENE, "bricks.yaml"), folder / "whole")
    return whole, run(load_experiment_text(SCENE + RECORD, "bricks.yaml"), folder / "partly")


def test_the_steps_are_the_same(runs: tuple[Finished, Finished]) -> None:
    whole, partly = (one.run.cells[0].trace() for one in runs)
    assert partly.step.tobytes() == whole.step.tobytes()
    rows = whole.contact[np.isin(whole.contact["step"], CONTACTS)]
    assert len(rows) > 100
    for name in rows.dtype.names or ():
        assert partly.recorded_contact[name].tobytes() == rows[name].tobytes(), name
    assert partly.recorded_pose.rows.tolist() == POSES.tolist()
    assert partly.recorded_pose.pose.tobytes() == whole.pose[POSES].tobytes()


def test_measures_and_checks_are_the_same(runs: tuple[Finished, Finished]) -> None:
    whole, partly = (one.run.results() for one in runs)
    assert whole["cells"][0]["measures"] == partly["cells"][0]["measures"]
    judged = [
        [(check["node"], check["passed"]) for check in one["checks"]] for one in (whole, partly)
    ]
    assert judged[0] == judged[1] != []


def test_a_check_finds_in_the_log_what_it_found_in_the_run(
    runs: tuple[Finished, Finished],
) -> None:
    always = runs[1].run.experiment.config.always
    assert always is not None
    found = outcomes_of(always, runs[1].run.cells[0])
    reported = {check["node"]: check for check in runs[1].run.results()["checks"]}
    assert set(found) == {"finite", "residual"}
    for name, outcome in found.items():
        (node,) = (node for node in reported if name in node)
        assert reported[node]["passed"] == outcome.passed
        assert reported[node]["measured"] == outcome.measured


def test_show_and_the_metadata_say_what_is_recorded(
    runs: tuple[Finished, Finished],
) -> None:
    recorded = {"contacts": "every 8", "poses": "from 0.25 to 0.5 s"}
    assert runs[1].run.cells[0].trace().metadata["recorded"] == recorded
    shown = [CliRunner().invoke(app, ["show", str(one.run.path)]).stdout for one in runs]
    assert "contacts recorded: every 8" in shown[1]
    assert "poses recorded: from 0.25 to 0.5 s" in shown[1]
    assert "recorded:" not in shown[0]


def test_what_there_is_is_replayed_and_drawn(
    runs: tuple[Finished, Finished], tmp_path: Path
) -> None:
    trace = runs[1].run.cells[0].trace()
    save(trace, tmp_path / "bricks.rrd")
    assert (tmp_path / "bricks.rrd").stat().st_size > 1000
    assert thumbnail(trace).startswith(b"\x89PNG")


def test_the_expected_size_follows(runs: tuple[Finished, Finished]) -> None:
    sizes = []
    for one in runs:
        experiment = one.run.experiment
        cells = experiment.cells()
        (expected,) = expected_log_sizes(cells, shared_plans(cells), experiment.text)
        found = one.run.cells[0].path.stat().st_size
        assert found / 3.0 <= expected <= found * 3.0  # as test_log_size has it
        sizes.append((expected, found))
    (expected, found), (expected_partly, found_partly) = sizes
    assert expected_partly < 0.5 * expected
    assert found_partly < 0.5 * found


def test_what_is_refused_is_refused_when_the_config_is_read() -> None:
    text = SCENE + "  force: {kind: peak_force, body: brick_1}\n" + RECORD
    says = r"bricks\.yaml:16:17: kind: peak_force takes the contacts of every step, and record"
    with pytest.raises(ConfigError, match=says):
        load_experiment_text(text, "bricks.yaml")


def test_a_refined_run_records_every_so_many_of_its_own_steps(tmp_path: Path) -> None:
    (tmp_path / "bricks.yaml").write_text(SCENE + RECORD)
    done = CliRunner().invoke(
        app, ["run", str(tmp_path / "bricks.yaml"), "--refine", "--runs", str(tmp_path / "runs")]
    )
    assert done.exit_code == 0, done.output
