"""A run of a config that extends another one is whole by itself: resumed, merged and read alone."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from command_line import lavender

from lavendersim import open_run
from lavendersim.runner import Run, run
from tests.drop_config import DROP

CHILD = """\
extends: ../base.yaml
sweep: {e: {path: scene.bodies.ball.surface.restitution, values: [0.3, 0.5]}}
expect: [{name: rebound, remove: true}]
"""


def logs(found: Run) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in found.path.glob("cells/*")}


@pytest.fixture
def config(tmp_path: Path) -> Path:
    (tmp_path / "base.yaml").write_text(DROP)
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases" / "drops.yaml").write_text(CHILD)
    return tmp_path / "cases" / "drops.yaml"


def test_a_run_is_read_without_the_files_it_was_made_from(config: Path, tmp_path: Path) -> None:
    made = run(config, tmp_path / "runs").run
    (tmp_path / "base.yaml").unlink()
    shutil.rmtree(config.parent)
    again = open_run(made.path)
    assert [cell.label for cell in again.cells] == ["e=0.3", "e=0.5"]
    assert again.experiment.text == (made.path / "config.yaml").read_text()
    assert again.experiment.text.startswith("# drops.yaml, ../base.yaml: merged")


def test_shards_are_merged_to_what_one_process_runs(config: Path, tmp_path: Path) -> None:
    whole, parts = logs(run(config, tmp_path / "whole").run), tmp_path / "parts"
    for part in ("1/2", "2/2"):
        done = lavender("run", config, "--shard", part, "--into", parts, where=tmp_path)
        assert done.returncode == 0, done.stderr
    (tmp_path / "base.yaml").unlink()
    done = lavender("merge", parts, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert logs(open_run(None, tmp_path / "runs")) == whole


def test_a_parent_that_has_changed_begins_a_new_run(config: Path, tmp_path: Path) -> None:
    arguments = ("run", config, "--resume", "--set", "duration=0.1")
    assert lavender(*arguments, where=tmp_path).returncode == 0
    assert "nothing to resume" in lavender(*arguments, where=tmp_path).stderr
    (tmp_path / "base.yaml").write_text(DROP.replace("mass: 1", "mass: 2"))
    assert lavender(*arguments, where=tmp_path).returncode == 0
    assert len([*(tmp_path / "runs").glob("2*")]) == 2


def test_a_folder_leaves_out_what_is_there_to_be_extended(config: Path, tmp_path: Path) -> None:
    (config.parent / "_part.yaml").write_text("duration: 0.1\n")
    (config.parent / "short.yaml").write_text("extends: drops.yaml\n")
    done = lavender("check", config.parent, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert {path.name[17:].split("-")[0] for path in (tmp_path / "runs").glob("2*")} == {
        "drops",
        "short",
    }
