"""Results as tables: numbers are numbers, what was not measured is null with a reason."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.measures.verdict import Verdict
from lavendersim.runner.result_tables import ROWS_AT_ONCE, _typed, cells_table, verdicts_table
from lavendersim.runner.run_results import CellResult, RunResults
from tests.marked_config import config

EXPERIMENT = load_experiment_text(
    config(
        measure="{m: {kind: simulated_duration}}",
        expect="[{name: low, measure: m, at_most: 2}, {name: falls, measure: m, decreasing: {along: dt}}]",  # noqa: E501
        sweep="{dt: {path: numerics.timestep, values: [1/100, 1/300]}}",
    ),
    "a.yaml",
)


@pytest.mark.parametrize(
    ("values", "kind", "typed"),
    [
        ([True, None], "bool", [True, None]),
        ([1, 2], "i8", [1, 2]),
        ([1, 2.5], "f8", [1.0, 2.5]),
        ([2**70, 1], "f8", [float(2**70), 1.0]),
        ([Fraction(1, 4), None], "f8", [0.25, None]),
        ([True, 1], "text", ["True", "1"]),
        ([(1, 2), [3.5]], "numbers", [[1.0, 2.0], [3.5]]),
        ([[1.0, 2.0], 3.0, None], "numbers", [[1.0, 2.0], [3.0], None]),
        (["a", 1], "text", ["a", "1"]),
        ([None], "f8", [None]),
    ],
)
def test_the_narrowest_kind_that_has_all_values(values: list, kind: str, typed: list) -> None:
    found = _typed(values)
    assert (found[0], list(found[1])) == (kind, typed)


def verdict(node: str, passed: bool = True) -> Verdict:
    return Verdict(node.split(" at ")[0], node, passed, 1.5, "at most 2", "none", "said", "a.mcap")


def run(*rows: CellResult, checks: tuple[Verdict, ...] = ()) -> Any:
    cells = [
        SimpleNamespace(index=one.index, label=one.label, coordinates=one.coordinates)
        for one in EXPERIMENT.cells()
    ]
    kept = RunResults("a", False, None, rows, None, checks, True)
    return SimpleNamespace(not_understood="", experiment=EXPERIMENT, cells=cells, results=lambda: kept, path=Path("run"))  # noqa: E501  # fmt: skip


def row(index: int, measure: Any, **violations: Any) -> CellResult:
    return CellResult(index, "", "complete", 100, {"m": measure}, 2.0, 1.0, 0.5, 1e-9, 1e-12, 3, violations)  # noqa: E501  # fmt: skip


def columns(table: Any) -> dict[str, list[Any]]:
    (batch,) = table.batches()
    return {name: list(values) for name, values in batch.items()}


CHECKS = (verdict("low at dt=1/100"), verdict("low at dt=1/300", passed=False), verdict("falls"))


def test_cells_have_axes_state_measures_and_costs() -> None:
    found = columns(cells_table(run(row(0, 1.5), row(1, "no contact"), checks=CHECKS)))
    assert found["cell"] == [0, 1]
    assert found["dt"] == [0.01, pytest.approx(1 / 300)]
    assert found["passed"] == [True, False]
    units = {one.name: one.unit for one in cells_table(run(row(0, 1.5), row(1, 2.5))).fields}
    assert (units["dt"], units["m"]) == ("s", "s")
    assert found["failed"] == [[], ["low at dt=1/300"]]
    assert found["m"] == [1.5, None]
    assert found["not_measured"] == [[], ["m: no contact"]]
    assert found["physics_us_per_step"] == [2.0, 2.0]
    assert found["not_converged_steps"] == [3, 3]
    assert "worst_signorini" not in found  # of logs without it


def test_costs_are_there_where_every_row_has_them() -> None:
    both = [row(k, 1.0, worst_signorini=0.25) for k in (0, 1)]
    assert columns(cells_table(run(*both)))["worst_signorini"] == [0.25, 0.25]
    one = [both[0], row(1, 1.0)]
    assert "worst_signorini" not in columns(cells_table(run(*one)))


def test_what_is_not_finite_stays_a_number() -> None:
    found = columns(cells_table(run(row(0, math.nan), row(1, math.inf))))["m"]
    assert math.isnan(found[0])
    assert found[1] == math.inf


def test_verdicts_over_several_cells_have_no_cell() -> None:
    found = columns(verdicts_table(run(row(0, 1.0), row(1, 1.0), checks=CHECKS)))
    assert found["cell"] == [0, 1, None]
    assert found["label"] == [0, 1, -1]
    assert found["node"] == [one.node for one in CHECKS]
    assert found["passed"] == [True, False, True]


def test_many_rows_come_in_batches() -> None:
    checks = tuple(verdict("falls") for _ in range(ROWS_AT_ONCE + 1))
    table = verdicts_table(run(row(0, 1.0), row(1, 1.0), checks=checks))
    assert [len(batch["node"]) for batch in table.batches()] == [ROWS_AT_ONCE, 1]
