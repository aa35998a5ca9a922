"""Every run has a directory of its own, and a config that is wrong leaves none."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

import lavendersim
from lavendersim.errors import ConfigError, UsageError
from tests.runner.small_configs import DROPS, write


def test_runs_within_one_second_do_not_share_a_directory(tmp_path: Path) -> None:
    config, root = write(tmp_path), tmp_path / "runs"
    paths = [lavendersim.run(config, root=root).run.path for _ in range(3)]
    assert len(set(paths)) == 3
    assert paths == sorted(paths), "names sort by age"
    assert (root / "latest").resolve() == paths[-1].resolve()
    for path in paths:
        files = [cell["file"] for cell in json.loads((path / "cells.json").read_text())["cells"]]
        assert len(set(files)) == 3
        assert all((path / file).stat().st_size for file in files)
        assert (path / "DONE").exists()
        assert (path / "config.yaml").read_text() == DROPS


def test_a_directory_called_latest_is_said_before_the_run_and_left_alone(tmp_path: Path) -> None:
    root = tmp_path / "runs"
    (root / "latest").mkdir(parents=True)
    (root / "latest" / "mine").touch()
    with pytest.raises(UsageError, match="latest: a directory; the link to the newest run"):
        lavendersim.run(write(tmp_path), root=root)
    assert [path.name for path in root.rglob("*")] == ["latest", "mine"]


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
def test_a_link_that_a_killed_process_left_half_made_goes_with_the_next_run(
    tmp_path: Path,
) -> None:
    root = tmp_path / "runs"
    root.mkdir()
    ended = subprocess.Popen(["true"])
    ended.wait()
    (root / f".latest-{ended.pid}").symlink_to("nowhere")
    (root / f".latest-{os.getppid()}").symlink_to("elsewhere")
    lavendersim.run(write(tmp_path), root=root)
    assert sorted(path.name for path in root.glob(".*")) == [f".latest-{os.getppid()}"]


def test_what_a_run_left_that_was_killed_before_its_index_goes_with_the_next_run(
    tmp_path: Path,
) -> None:
    root = tmp_path / "runs"
    killed, others = root / "20260101T000000Z-drop-01234567", root / "of_others"
    for folder in (killed, others):
        folder.mkdir(parents=True)
        (folder / ".resolved.1-1.unfinished.json").touch()
    lavendersim.run(write(tmp_path), root=root)
    assert [*killed.iterdir()] == []
    assert [path.name for path in others.iterdir()] == [".resolved.1-1.unfinished.json"]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("mass: 1.0", "mass: -1.0"),
        ("numerics: chapter", "numerics: chaptre"),
        ("values: [0.2, 0.5, 0.8]", "values: [0.2, 0.5, 1.8]"),
    ],
)
def test_a_bad_config_leaves_no_directory(tmp_path: Path, right: str, wrong: str) -> None:
    root = tmp_path / "runs"
    assert right in DROPS
    with pytest.raises(ConfigError):
        lavendersim.run(write(tmp_path, DROPS.replace(right, wrong)), root=root)
    assert not root.exists()


def test_cells_that_are_the_same_simulation_share_one_log(tmp_path: Path) -> None:
    """A union of products may reach one simulation twice; two processes must not write one file."""
    axis = "{path: scene.bodies.ball.surface.restitution, values: [0.2, 0.5, 0.8]}"
    again = "{path: scene.bodies.ball.surface.restitution, values: [0.5, 0.9]}"
    text = DROPS.replace(f"sweep:\n  e: {axis}", f"sweep:\n  - e: {axis}\n  - f: {again}")
    text = text[: text.index("measure:\n")]
    finished = lavendersim.run(write(tmp_path, text), root=tmp_path / "runs", jobs=2)
    paths = [cell.path for cell in finished.run.cells]
    assert len(paths) == 5
    assert len(set(paths)) == 4
    assert paths[1] == paths[3]
    assert [outcome.cell for outcome in finished.outcomes] == [0, 1, 2, 3, 4]
    assert all(cell.trace().status == "complete" for cell in finished.run.cells)
