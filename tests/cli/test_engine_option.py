"""`--engine`: two small scenes by lavender and MuJoCo, end to end; the matrix; what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lavender_cli.main import app
from lavendersim.peers import catalogue
from tests.engines import BALL, BOX, needs

CLAIM = """
measure: {height: {kind: position, body: ball, along: [0, 0, 1], time: 0.5}}
expect: [{name: height, measure: height, equals: {value: 2.77375, absolute: 0.03}}]
always: {}
"""


def lavender(*words: str | Path) -> tuple[int, str, str]:
    found = CliRunner().invoke(app, [str(word) for word in words])
    return found.exit_code, found.stdout, found.stderr


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_an_unknown_engine_is_refused_before_a_file_is_read(tmp_path: Path) -> None:
    code, _, said = lavender("run", tmp_path / "none.yaml", "--engine", "mujco")
    assert code == 2
    assert 'no engine is called "mujco"' in said
    assert 'did you mean "mujoco"?' in said


def test_one_that_is_not_installed_is_refused_with_the_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(catalogue, "installed_version", lambda name: "")
    config = write(tmp_path, "ball.yaml", f"{BALL}engine: mujoco\n")
    code, _, said = lavender("run", config, "--runs", tmp_path / "runs")
    assert code == 2
    assert f"{config}:8:1: engine: MuJoCo is not installed" in said.replace("\n", "")
    assert "`pip install mujoco`" in said


@needs("mujoco")
def test_both_engines_run_two_scenes_end_to_end(tmp_path: Path) -> None:
    """3 + 2 t - g t^2/2 = 2.77375 m at 0.5 s; Euler's method is 24.5 mm below."""
    ball = write(tmp_path, "ball.yaml", BALL + CLAIM)
    box = write(tmp_path, "box.yaml", BOX)
    runs = tmp_path / "runs"
    code, _, said = lavender("run", ball, box, "-e", "all", "--runs", runs, "--json")
    assert code == 0, said
    tables = json.loads(lavender("run", ball, "-e", "lavender,mujoco", "--runs", runs, "--json")[1])
    cells = tables[0]["cells"] if isinstance(tables, list) else tables["cells"]
    assert [cell["label"] for cell in cells] == ["engine=lavender", "engine=mujoco"]
    assert [cell["measures"]["height"] for cell in cells] == pytest.approx(
        [2.77375, 2.77375 - 9.81 * 0.01 * 0.25], abs=1e-9
    )
    for verb in ("show", "judge", "verify"):
        code, shown, said = lavender(verb, runs / "latest")
        assert code == 0, shown + said
    assert "not judged" in lavender("judge", runs / "latest")[1]


@needs("mujoco")
def test_a_matrix_marks_what_is_refused_and_goes_on(tmp_path: Path) -> None:
    ball = write(tmp_path, "ball.yaml", BALL + CLAIM)
    text = (BALL + CLAIM).replace("mass: 2,", "mass: 2, drag: {linear: 0.001},")
    drag = write(tmp_path, "drag.yaml", text)
    page = tmp_path / "engines.html"
    words = ("-e", "all", "--runs", tmp_path / "runs", "--report", page, "--json")
    code, shown, said = lavender("check", ball, drag, *words)
    found = json.loads(shown)
    verdicts = {
        (one["case"].split("/")[1], one["solver"]): one["verdict"] for one in found["entries"]
    }
    assert verdicts == {
        ("ball", "lavender"): "passes",
        ("ball", "mujoco"): "passes",
        ("drag", "lavender"): "passes",
        ("drag", "mujoco"): "refused",
    }
    assert code == 0, said
    assert "refused" in page.read_text()


@needs("mujoco")
def test_the_plan_of_another_engine_states_its_law(tmp_path: Path) -> None:
    config = write(tmp_path, "ball.yaml", f"{BALL}engine: mujoco-stiff\n")
    code, shown, _ = lavender("plan", config)
    assert code == 0
    assert "engine mujoco-stiff, which plans by itself" in shown
    assert "law        soft contacts in a convex problem" in shown
    assert "midpoint" not in shown
