"""What is suspicious of a config is a warning on stderr; with --strict nothing is run."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import lavender

TEXT = """scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 0.5}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.1]}
duration: 0.01
measure:
  speed: {kind: top_speed}
"""
WARNED = ["scene.yaml:3:45: ", "scene.yaml:6:1: "]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scene.yaml").write_text(TEXT)
    return tmp_path


def test_a_run_warns_prints_what_it_measured_and_is_listed_as_unclaimed(folder: Path) -> None:
    done = lavender("run", "scene.yaml", where=folder)
    assert done.returncode == 0
    warned = [line for line in done.stderr.splitlines() if ": warning: " in line]
    assert [line.split("warning")[0] for line in warned] == WARNED
    assert "speed: " in done.stdout
    assert lavender("ls", where=folder).stdout.startswith("none  runs/")
    assert "scene" in lavender("ls", "--verdict", "unclaimed", where=folder).stdout
    assert lavender("ls", "--verdict", "pass", where=folder).stdout == ""


@pytest.mark.parametrize("verb", ["run", "check", "plan", "cost"])
def test_strict_refuses_and_runs_nothing(folder: Path, verb: str) -> None:
    done = lavender(verb, "scene.yaml", "--strict", where=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert [line[: len(WARNED[0])].split(" ")[0] for line in done.stderr.splitlines()] == [
        place.strip() for place in WARNED
    ]
    assert sorted(folder.iterdir()) == [folder / "scene.yaml"]
