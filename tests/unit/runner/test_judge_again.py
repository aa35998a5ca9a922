"""A run judged from its logs alone: statuses and numbers are theirs, damage fails its claims."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.judge_again import judge_again
from lavendersim.runner.run_directory import RunCell
from tests.marked_config import config
from tests.unit.measures.synthetic import trace_of

EXPERIMENT = load_experiment_text(
    config(
        measure="{impulse: {kind: impact_impulse, body: ball}}",
        expect="[{name: light, measure: impulse, at_most: 2}]",
        sweep="{e: {path: scene.bodies.ball.surface.restitution, values: [0.1, 0.5]}}",
    ),
    "a.yaml",
)


def cell(index: int, impulse: float, status: str = "complete", damage: str = "") -> RunCell:
    log: Any = trace_of([0.0] * 4, [(1, impulse, 0.0)], status=status)
    label = f"e={(0.1, 0.5)[index]}"
    coordinates = {"e": (0.1, 0.5)[index]}
    one = Kept(index, label, coordinates, Path("run/cells"), f"{index}.mcap", "as the table says", None, [log])  # noqa: E501  # fmt: skip
    one._damage.append(damage)
    return one


class Kept(RunCell):
    """A cell whose log is at hand."""

    def release(self) -> None:
        """Keep the log."""


def run(*cells: RunCell) -> Any:
    return SimpleNamespace(experiment=EXPERIMENT, cells=list(cells))


def test_what_the_tables_say_counts_for_nothing() -> None:
    found = judge_again(run(cell(0, 1.5), cell(1, 3.0)))
    assert [one.status for one in found.cells] == ["complete", "complete"]
    assert [one.values for one in found.measured] == [{"impulse": 1.5}, {"impulse": 3.0}]
    assert [one.passed for one in found.verdicts] == [True, False]
    assert not found.good
    table = found.table()
    assert [row["measures"] for row in table["cells"]] == [{"impulse": 1.5}, {"impulse": 3.0}]
    assert table["passed"] is False
    assert judge_again(run(cell(0, 1.5), cell(1, 1.0))).good


def test_a_cell_that_ended_early_by_its_log_did_so() -> None:
    found = judge_again(run(cell(0, 1.0), cell(1, 1.0, status="diverged: ball")))
    assert [one.label for one in found.ended_early] == ["e=0.5"]
    assert not found.good


def test_a_damaged_log_is_named_once_and_keeps_the_status_of_the_table() -> None:
    damaged = [cell(index, 1.0, damage="a.mcap: cut") for index in (0, 1)]
    found = judge_again(run(*damaged))
    assert found.damaged == ["a.mcap: cut"]
    assert [one.status for one in found.cells] == ["as the table says"] * 2
    assert not found.good


def test_a_number_that_json_does_not_have_is_a_text() -> None:
    table = judge_again(run(cell(0, float("nan")), cell(1, 1.0))).table()
    assert table["cells"][0]["measures"] == {"impulse": "nan"}
