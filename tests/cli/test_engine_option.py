"""`--engine`: two small scenes by lavender and MuJoCo, end to end; the matrix; what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import lavender

from lavender_cli.solver_matrix import print_matrix
from lavendersim.runner.matrix_entry import Entry
from lavendersim.runner.solver_matrix import Case
from tests.engines import BALL, BOX, needs

CLAIM = """
measure: {height: {kind: position, body: ball, along: [0, 0, 1], time: 0.5}}
expect: [{name: height, measure: height, equals: {value: 2.77375, absolute: 0.03}}]
always: {}
figure:
  caption: What the ball has.
  panels: [{kind: time_series, column: energy, x_label: "t [s]", y_label: "energy [J]"}]
"""
REPLAY = ("replay", "--cell", "1", "--save", "ball.rrd")


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_an_unknown_engine_is_refused_before_a_file_is_read(tmp_path: Path) -> None:
    for verb in ("run", "check"):
        found = lavender(verb, "none.yaml", "--engine", "mujco", where=tmp_path)
        assert found.returncode == 2
        assert 'no engine is called "mujco"' in found.stderr
        assert 'did you mean "mujoco"?' in found.stderr


@needs("mujoco")
def test_both_engines_run_two_scenes_end_to_end(tmp_path: Path) -> None:
    """3 + 2 t - g t^2/2 = 2.77375 m at 0.5 s; Euler's method is 24.5 mm below."""
    write(tmp_path, "box.yaml", BOX)
    write(tmp_path, "ball.yaml", BALL + CLAIM)
    words = ("run", "box.yaml", "ball.yaml", "-e", "lavender,mujoco", "--json")
    found = lavender(*words, where=tmp_path)
    assert found.returncode == 0, found.stderr
    (cells,) = (one["cells"] for one in json.loads(found.stdout) if one["experiment"] == "ball")
    assert [cell["label"] for cell in cells] == ["engine=lavender", "engine=mujoco"]
    assert [cell["measures"]["height"] for cell in cells] == pytest.approx(
        [2.77375, 2.77375 - 9.81 * 0.01 * 0.25], abs=1e-9
    )
    for words in (("show",), ("judge",), ("verify",), ("plot",), REPLAY):
        found = lavender(*words, where=tmp_path)
        assert found.returncode == 0, found.stdout + found.stderr
    assert [*tmp_path.rglob("ball*.png")]
    assert (tmp_path / "ball.rrd").stat().st_size > 0
    (box,) = tmp_path.glob("runs/*-box-*")  # which rests on contacts of MuJoCo's
    found = lavender("replay", str(box), "--cell", "1", "--save", "box.rrd", where=tmp_path)
    assert found.returncode == 0, found.stdout + found.stderr
    assert (tmp_path / "box.rrd").stat().st_size > 0
    assert "always: residual: not judged" in lavender("judge", where=tmp_path).stdout
    shown = lavender("show", where=tmp_path).stdout
    assert "plan of engine=mujoco\n  version   MuJoCo" in shown
    assert "  law       soft contacts in a convex problem" in shown
    assert "nan" not in shown
    # Velocities are in the log of MuJoCo alone, by which its steps are judged.
    found = lavender("judge", str(box), "--laws", where=tmp_path)
    assert found.returncode == 0
    assert found.stderr.startswith("engine=lavender: not judged: ")
    assert "record.velocities is false" in found.stderr
    assert found.stdout.startswith("engine=mujoco  120 steps")


@needs("mujoco")
def test_a_matrix_marks_what_is_refused_and_goes_on(tmp_path: Path) -> None:
    write(tmp_path, "ball.yaml", BALL + CLAIM)
    text = (BALL + CLAIM).replace("mass: 2,", "mass: 2, drag: {linear: 0.001},")
    text = text.replace("always: {}", "always: {momentum: none}")
    write(tmp_path, "drag.yaml", text)
    words = (
        "check",
        ".",
        "-e",
        "lavender,mujoco",
        "--starts",
        "2",
        "--report",
        "engines.html",
        "--json",
    )
    done = lavender(*words, where=tmp_path)
    found = json.loads(done.stdout)
    verdicts = {
        (one["case"].rpartition("/")[2], one["solver"]): one["verdict"] for one in found["entries"]
    }
    assert verdicts == {
        ("ball", "lavender"): "passes",
        ("ball", "mujoco"): "passes",
        ("drag", "lavender"): "passes",
        ("drag", "mujoco"): "refused",
    }
    assert done.returncode == 0, done.stderr
    # An energy that a level shift of a ball in flight leaves alone is the same of both starts.
    spread = [(one["least"], one["most"]) for one in found["entries"] if one["least"] is not None]
    assert len(spread) == 3
    assert all(0.0 <= least <= most for least, most in spread)
    assert "refused" in (tmp_path / "engines.html").read_text()


@needs("mujoco")
def test_the_plan_of_another_engine_says_its_law(tmp_path: Path) -> None:
    write(tmp_path, "ball.yaml", f"{BALL}engine: mujoco-stiff\n")
    found = lavender("plan", "ball.yaml", where=tmp_path)
    assert found.returncode == 0
    assert "engine mujoco-stiff, which plans by itself" in found.stdout
    assert "law        soft contacts in a convex problem" in found.stdout
    assert "midpoint" not in found.stdout


def test_the_matrix_of_engines_says_of_every_square_its_number_spread_and_steps(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Also of what passes; what was not reported has no number, and stands in the engine's line."""
    claim = "drift: 1e-7, expected at most 1e-06"
    reported = {"claim": claim, "cost": 0.002, "contacts": 24.0, "iterations": 1.5}
    made = [
        Entry("tall/tower", "lavender", "passes", least=1e-8, most=1e-7, **reported),
        Entry("tall/tower", "drake-hydroelastic", "passes", claim=claim, cost=0.5),
    ]
    case = Case("tall/tower", Path("tower.yaml"), False, "")
    engines = ["lavender", "drake-hydroelastic"]
    print_matrix([case], engines, made, {}, width=300, of_engines=True)
    shown = capsys.readouterr().out
    of_steps = "2 ms per simulated s, 24 contacts a step, 1.5 iterations a step"
    assert f"{claim} (over its starts 1e-08 to 1e-07); {of_steps}" in shown
    assert "iterations: not reported by its Python; room for contacts: no limit" in shown
    assert shown.count(claim) == 2
    print_matrix([case], engines, made, {}, width=300)  # of solvers what passes is not listed
    assert claim not in capsys.readouterr().out
