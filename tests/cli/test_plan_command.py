"""`lavender plan` and `lavender show`: what they print, at any width, and what they refuse."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import lavender

from lavender_cli.plan import number_lines, write
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS
from lavendersim.experiment import load_experiment
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.explanation import Explanation, explain

STACK = Path(__file__).parents[2] / "configs" / "scenes" / "stack_of_six.yaml"
REFUSED = "effects: {restitution: off, drga: on}\n"
SWEPT = "sweep:\n  e: {path: scene.bodies.ball.surface.restitution, values: [0, 0.5, 0.8]}\n"


@pytest.fixture(scope="module")
def stack() -> Explanation:
    return explain(shared_plans(load_experiment(STACK).cells())[0])


def printed(explained: Explanation, width: int, capsys: pytest.CaptureFixture[str]) -> list[str]:
    write(explained, "title", width)
    return re.sub(r"\x1b\[[\d;]*m", "", capsys.readouterr().out).splitlines()


@pytest.mark.parametrize("width", [80, 120])
def test_the_table_fits_and_loses_nothing(
    stack: Explanation, width: int, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = printed(stack, width, capsys)
    assert max(map(len, lines)) <= width
    words = " ".join(lines).split()
    assert "…" not in " ".join(lines)
    for part in stack.parts():
        assert part.name in " ".join(words).replace(",", " ").split()
        if part.on:
            assert set(part.reason.split()) <= set(words) | {w.rstrip(";") for w in words}
            for names in (*part.fields.values(), *part.kernels.values()):
                assert set(names) <= {word.rstrip(";") for word in words}


@pytest.mark.parametrize("verb", ["run", "check", "plan", "plan --json"])
def test_switches_that_cannot_be_exit_2_and_leave_nothing(
    drop: Path, tmp_path: Path, verb: str
) -> None:
    drop.write_text(drop.read_text() + REFUSED)
    line = drop.read_text().splitlines().index(REFUSED.strip()) + 1
    name, *options = verb.split()
    done = lavender(name, drop, *options, where=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    first, second = done.stderr.splitlines()
    assert first.startswith(f"{drop}:{line}:11: effects.restitution: the scene requires it: ")
    assert second == (
        f'{drop}:{line}:29: effects.drga: no effect or shape pair is called "drga"; '
        'did you mean "drag"?'
    )
    assert not (tmp_path / "runs").exists()


def test_a_pipe_gets_whole_lines(tmp_path: Path) -> None:
    lines = lavender("plan", STACK, where=tmp_path).stdout.splitlines()
    for effect in EFFECTS:
        assert any(re.match(rf"{effect.name} +(on |off)  \S", line) for line in lines)
    assert any(line.endswith("friction; velocity 6: jxx jxy jxz jyy jyz jzz") for line in lines)
    assert lines[0] == "stack_of_six: 1 cell"
    assert not any(line != line.rstrip() for line in lines)


def test_json_has_all_that_the_table_has(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text()
    drop.write_text(text[: text.index("measure:")] + SWEPT + "effects: {friction: on}\n")
    plan = json.loads(lavender("plan", drop, "--json", where=tmp_path).stdout)
    assert list(plan["effects"]) == [effect.name for effect in EFFECTS]
    assert list(plan["shape_pairs"]) == list(SHAPE_PAIRS)
    assert plan["effects"]["restitution"]["required_by"] == [1, 2]
    assert plan["effects"]["restitution"]["requirement"] == "required by 2 of 3 cells: e=0.5; e=0.8"
    assert plan["effects"]["friction"]["forced"] == "forced on"
    assert plan["effects"]["friction"]["fields"]["pair"] == ["friction"]
    assert plan["effects"]["friction"]["kernels"]["effects.friction"]
    assert plan["choices"]["effects"] == "friction: on"
    assert [cell["label"] for cell in plan["cells"]] == ["e=0", "e=0.5", "e=0.8"]
    assert plan["others"] == []
    table = lavender("plan", drop, where=tmp_path).stdout
    assert plan["digest"] in table
    for part in (*plan["effects"].values(), plan["solver"]):
        assert part["reason"] in table
        assert part["requirement"] in table


def test_a_folder_gives_the_plan_of_each_config(drop: Path, tmp_path: Path) -> None:
    later = drop.read_text().replace(f"name: {drop.stem}", "name: later")
    (drop.parent / "later.yaml").write_text(later)
    done = lavender("plan", drop.parent, where=tmp_path)
    lines = done.stdout.splitlines()
    names = [line.partition(":")[0] for line in lines if line.endswith(": 1 cell")]
    assert (done.returncode, len(names), done.stderr) == (0, 2, "")
    plans = json.loads(lavender("plan", drop.parent, "--json", where=tmp_path).stdout)
    assert [plan["experiment"] for plan in plans] == names
    assert plans[0]["digest"] == plans[1]["digest"]


def test_it_ends_with_the_expected_size_of_the_logs_in_all_and_by_cell(
    drop: Path, tmp_path: Path
) -> None:
    alone = lavender("plan", drop, where=tmp_path).stdout.splitlines()[-1]
    assert re.fullmatch(r"expected size of the log: about \d+ kB", alone)
    text = drop.read_text()
    drop.write_text(text[: text.index("measure:")] + SWEPT)
    sizes = json.loads(lavender("plan", drop, "--json", where=tmp_path).stdout)
    assert len(sizes["expected_log_sizes"]) == 3
    *_, whole, first, second, third = lavender("plan", drop, where=tmp_path).stdout.splitlines()
    assert re.match(r"expected size of the logs: about \d+ kB, .* in each of 3 cells$", whole)
    assert [line.split()[-1] for line in (first, second, third)] == ["e=0", "e=0.5", "e=0.8"]
    assert sizes["expected_log_sizes"][0] == pytest.approx(float(first.split()[0]) * 1e3, rel=0.05)


def test_show_tells_the_plan_of_the_log(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text()
    swept = text[: text.index("measure:")].replace("duration: 0.5", "duration: 0.02") + SWEPT
    drop.write_text(swept + "effects: {drag: on}\n")
    assert lavender("run", drop, where=tmp_path).returncode == 0
    shown = lavender("show", where=tmp_path).stdout
    lines = shown[shown.index("\nplan\n") + 1 : shown.index("\ncells ")].splitlines()
    assert lines[1] == "  overridden by hand: drag forced on"
    assert any(
        re.match(r"  drag +on   forced on; not required: no body has drag$", x) for x in lines
    )
    assert any(re.match(r"  sphere_plane +on   floor and ball$", line) for line in lines)
    assert any(line.endswith("required by 2 of 3 cells: e=0.5; e=0.8") for line in lines)
    off = [line for line in lines if line.startswith("  off: ")]
    assert len(off) == 1
    assert {"friction", "rotation"} <= set(off[0].removeprefix("  off: ").split(", "))


def test_show_tells_each_plan_of_a_run(drop: Path, tmp_path: Path) -> None:
    text = drop.read_text()
    switched = "sweep:\n  f: {path: effects.restitution, values: [on, off]}\n"
    drop.write_text(
        text[: text.index("measure:")].replace("duration: 0.5", "duration: 0.02")
        + switched
        + "effects: {force: true}\n"
    )
    assert lavender("run", drop, where=tmp_path).returncode == 0
    shown = lavender("show", where=tmp_path).stdout
    assert re.findall(r"^plan.*$", shown, re.M) == ["plan of f=on", "plan of f=off"]
    assert shown.count("overridden by hand: restitution forced off") == 1


FORMULAS = """
constants: {r: 0.1, m: 2 * $r}
scene:
  bodies: {ball: {shape: {kind: sphere, radius: $r}, mass: $m, position: [0, 0, 1]}}
duration: 0.1
always: {}
sweep: {r: {path: constants.r, values: [0.2, 0.3]}}
"""


def test_numbers_of_formulas_are_listed_with_their_places(tmp_path: Path) -> None:
    config = tmp_path / "made.yaml"
    config.write_text(FORMULAS)
    lines = number_lines(load_experiment(config))
    assert lines == [
        "numbers from formulas, of the first cell (r=0.2)",
        f"  constants.m = 0.4  from  2 * $r  at {config}:2:24",
        f"  scene.bodies.ball.shape.radius = 0.2  from  $r  at {config}:4:49",
        f"  scene.bodies.ball.mass = 0.4  from  $m  at {config}:4:60",
    ]
    assert number_lines(load_experiment(STACK)) == []
