"""Exit codes and streams of the command line: 0 good, 1 a check failed, 2 usage or config."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest


def lavender(*arguments: object, where: Path) -> subprocess.CompletedProcess[str]:
    """Run the command line in `where`, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "lavender_cli.main", *map(str, arguments)],
        cwd=where,
        capture_output=True,
        text=True,
        env={**os.environ, "NO_COLOR": "1"},
        check=False,
    )


def test_a_good_run_exits_0_and_leaves_a_finished_run(drop: Path, tmp_path: Path) -> None:
    done = lavender("run", drop, where=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "pass  rebound" in done.stdout
    latest = tmp_path / "runs" / "latest"
    names = {path.name for path in latest.iterdir()}
    assert {"config.yaml", "resolved.yaml", "cells", "results.json", "env.json", "DONE"} <= names
    assert len(list((latest / "cells").glob("*.mcap"))) == 1


def test_an_unmet_expectation_exits_1_and_shows_what_was_measured(
    drop: Path, tmp_path: Path
) -> None:
    drop.write_text(drop.read_text().replace("[0.02, 0.03]", "[0.2, 0.3]"))
    done = lavender("run", drop, where=tmp_path)
    assert done.returncode == 1
    for part in ("FAIL  rebound", "measured", "expected   between 0.2 and 0.3", ".mcap"):
        assert part in done.stdout
    assert "Traceback" not in done.stderr


def test_every_defect_of_every_file_is_reported_before_anything_runs(
    drop: Path, tmp_path: Path
) -> None:
    (tmp_path / "a.yaml").write_text(drop.read_text().replace("mass: 1.0", "mass: -1.0"))
    (tmp_path / "b.yaml").write_text(drop.read_text().replace("duration", "durration"))
    done = lavender("run", tmp_path, where=tmp_path)
    assert done.returncode == 2
    assert f"{tmp_path}/a.yaml:8:" in done.stderr
    assert f"{tmp_path}/b.yaml:" in done.stderr
    assert "duration" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("verb", ["plot", "show", "replay"])
def test_without_a_run_one_sentence_says_how_to_make_one(verb: str, tmp_path: Path) -> None:
    done = lavender(verb, where=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "runs has no finished run: start one with `lavender run CONFIG`\n"


def test_json_output_is_one_document(drop: Path, tmp_path: Path) -> None:
    done = lavender("run", drop, "--json", where=tmp_path)
    (table,) = json.loads(done.stdout)
    assert table["passed"] is True
    assert table["cells"][0]["measures"]["rebound"] == pytest.approx(0.025, rel=0.1)
    # 0.5 s at 240 Hz
    assert table["cells"][0]["steps"] == 120


def test_the_verbs_of_a_run_read_what_it_left(drop: Path, tmp_path: Path) -> None:
    lavender("run", drop, where=tmp_path)
    assert "pass  runs/" in lavender("ls", where=tmp_path).stdout
    shown = lavender("show", where=tmp_path).stdout
    assert "How high?" in shown
    assert "rotation        off: ball" in shown
    checked = lavender("check", drop, where=tmp_path)
    assert "1 of 1 expectations met in 1 experiments" in checked.stdout
    plan = json.loads(lavender("plan", drop, "--json", where=tmp_path).stdout)
    assert plan["effects"]["rotation"]["on"] is False
    assert plan["spec"]["shape_pairs"] == ["sphere_plane"]
    no_figure = lavender("plot", where=tmp_path)
    assert no_figure.returncode == 2
    assert "no figure section" in no_figure.stderr


def test_a_cut_off_log_is_recovered_and_exits_3(drop: Path, tmp_path: Path) -> None:
    lavender("run", drop, where=tmp_path)
    (log,) = (tmp_path / "runs" / "latest" / "cells").glob("*.mcap")
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(log.read_bytes()[:-100])
    done = lavender("recover", cut, tmp_path / "whole.mcap", where=tmp_path)
    assert done.returncode == 3, done.stderr
    from lavendersim.trace import open_trace

    assert open_trace(tmp_path / "whole.mcap").status.startswith("recovered")
