"""The expectations of an experiment and the logs of its cells in; one Verdict per claim out.

`judge_nodes` gives the same claims from the config alone, so a test runner can list them before
anything has run. An expectation that selects no cell is one claim that fails.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol

from lavendersim.errors import LavenderError
from lavendersim.experiment.expect_specs import ExpectSpec
from lavendersim.experiment.measure_specs import MeasureSpec
from lavendersim.measures.cell_judgements import judge_cell
from lavendersim.measures.selection import coordinates_text, select, telling_axes
from lavendersim.measures.sweep_judgements import judge_sweep
from lavendersim.measures.values import Values
from lavendersim.measures.verdict import Outcome, Verdict, failure
from lavendersim.measures.views import Cell

Measures = Mapping[str, MeasureSpec]


class _Planned(Protocol):
    """What `judge_nodes` needs of an experiment."""

    @property
    def measures(self) -> Measures: ...
    @property
    def expectations(self) -> Sequence[ExpectSpec]: ...
    def cells(self) -> Sequence[Any]: ...


def judge_nodes(experiment: _Planned) -> list[str]:
    """Return the names of all verdicts of an experiment, in the order of `judge`."""
    claims = _claims(experiment.measures, experiment.expectations, experiment.cells())
    return [node for _, node, _ in claims]


def judge(
    measures: Measures,
    expectations: Sequence[ExpectSpec],
    cells: Sequence[Cell],
    values: Values | None = None,
) -> list[Verdict]:
    """Return one verdict per claim, in the order of the expectations and of the cells.

    values: measures of these cells that were taken already.
    """
    values = values or Values(measures)
    verdicts = []
    for expectation, node, chosen in _claims(measures, expectations, cells):
        outcome = _outcome(expectation, chosen, values)
        verdicts.append(_verdict(expectation, node, outcome, _path(chosen)))
    return verdicts


def _claims(
    measures: Measures, expectations: Sequence[ExpectSpec], cells: Sequence[Any]
) -> Iterator[tuple[ExpectSpec, str, list[Any]]]:
    """Yield (expectation, node, cells to judge) of every claim."""
    for expectation in expectations:
        chosen = select(cells, measures[expectation.measure].at, expectation.at)
        if not expectation.per_cell or not chosen:
            yield expectation, expectation.name, chosen
            continue
        axes = telling_axes(chosen, expectation.at)
        for cell in chosen:
            told = [axis for axis in cell.coordinates if axis in axes]
            where = coordinates_text(cell.coordinates, told)
            yield (
                expectation,
                f"{expectation.name} at {where}" if where else expectation.name,
                [cell],
            )


def _outcome(expectation: ExpectSpec, cells: Sequence[Cell], values: Values) -> Outcome:
    if not cells:
        return failure(expectation.judgement, "the expectation selects no cell of the sweep")
    try:
        for cell in cells:
            if (status := cell.trace().status) != "complete":
                return failure("a complete run", f"{cell.label or 'the cell'}: {status}")
        if expectation.per_cell:
            row = values.row(expectation.measure, cells[0])
            return judge_cell(expectation, row, cells[0].trace())
        return judge_sweep(expectation, cells, values.of(expectation.measure))
    except LavenderError as error:  # a log that is damaged, or has no such topic, fails alone
        return failure("a log that can answer", str(error))


def _path(cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    return str(cells[0].path if len(cells) == 1 else cells[0].path.parent)


def _verdict(expectation: ExpectSpec, node: str, outcome: Outcome, path: str) -> Verdict:
    lines = [
        f"{node}: {'passed' if outcome.passed else 'FAILED'}",
        f"  measured   {outcome.measured!r} ({expectation.measure})",
        f"  expected   {outcome.expected}",
        f"  tolerance  {outcome.tolerance}",
    ]
    lines += [f"  because    {outcome.reason}"] if outcome.reason else []
    lines += [f"  log        {path}"] if path else []
    return Verdict(
        name=expectation.name,
        node=node,
        passed=outcome.passed,
        measured=outcome.measured,
        expected=outcome.expected,
        tolerance=outcome.tolerance,
        message="\n".join(lines),
        path=path,
    )
