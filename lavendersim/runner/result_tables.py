"""The tables `cells` and `verdicts` of a run, from its results: a row for each cell, each claim.

    cells      cell  label  <axes>  status  steps  passed  failed  <measures>  not_measured  <costs>
    verdicts   cell  label  name  node  passed  measured  expected  ...

Numbers are numbers: a ratio of the sweep is one, NaN and infinities stay. What could not be
measured is null, and `not_measured` says why.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final

from lavendersim.arrow import Batch, Field, Kind, Table
from lavendersim.arrow.fields import distinct
from lavendersim.measures.judging import cells_of_claims
from lavendersim.measures.meanings import meaning_of
from lavendersim.quantities.unit_at import unit_at

from .log_tables import key_fields
from .run_results import CellResult

if TYPE_CHECKING:
    from lavendersim.experiment import Experiment
    from lavendersim.measures.verdict import Verdict

    from .run_directory import Run

ROWS_AT_ONCE: Final = 4096

_STATE: Final = (
    Field("status", "text", "how the cell ended: `complete`, or why not"),
    Field("steps", "i8", "steps that were simulated"),
    Field("passed", "bool", "whether every claim on this cell alone was met; null without one"),
    Field("failed", "texts", "the claims on this cell alone that were not met"),
)
_NOT_MEASURED: Final = Field("not_measured", "texts", "measures without a number, and why")
_COSTS: Final = (
    Field("physics_us_per_step", "f8", "time that the physics of a step takes", "us"),
    Field("logging_us_per_step", "f8", "time that the log of a step takes", "us"),
    Field("compile_s", "f8", "time of composing, compiling and loading the kernel", "s"),
    Field("tolerance", "f8", "residual that a step may leave", "m/s"),
    Field("worst_residual", "f8", "largest residual of any step", "m/s"),
    Field("not_converged_steps", "i8", "steps whose residual stayed above the tolerance"),
    Field("worst_signorini", "f8", "largest violation of Signorini's law in any step", "m/s"),
    Field("worst_cone", "f8", "largest distance from the friction cone in any step", "N s"),
    Field("worst_dissipation", "f8", "largest violation of maximum dissipation", "J"),
)
_VERDICT: Final = (
    Field("name", "text", "name of the expectation, check or control"),
    Field("node", "text", "the claim: its name, and where it is judged"),
    Field("passed", "bool", "whether the claim was met"),
    Field("measured", "f8", "the decisive number: of several, the worst"),
    Field("expected", "text", "what was expected"),
    Field("tolerance", "text", "by how much it may be off"),
    Field("follows", "bool", "failed because the cell did not complete"),
    Field("margin", "f8", "share of the bound that is left; below 0 outside", "-"),
    Field("message", "text", "the verdict in full"),
)


def cells_table(run: Run) -> Table:
    """Return the table of cells. UsageError where the run did not finish."""
    results = run.results()
    rows, places = results.cells, _places(run, results.checks)
    known = None if run.not_understood else run.experiment
    named: Iterator[str] = (name for row in rows for name in row.measures)
    swept: Iterator[str] = (axis for cell in run.cells for axis in cell.coordinates)
    judged: dict[int, list[Verdict]] = {}
    for check in results.checks:
        if (index := places.get(check.node)) is not None:
            judged.setdefault(index, []).append(check)
    axes = {
        axis: _typed([cell.coordinates.get(axis) for cell in run.cells])
        for axis in (known.axes if known else dict.fromkeys(swept))
    }
    measures = {
        name: _typed([_number(row.measures.get(name)) for row in rows])
        for name in (known.measures if known else dict.fromkeys(named))
    }
    fields = distinct(
        {
            "key": key_fields(run),
            "axis": [
                Field(axis, kind, f"axis {axis!r}", _unit_of(known, axis, kind))
                for axis, (kind, _) in axes.items()
            ],
            "cell": list(_STATE),
            "measure": [
                Field(name, kind, *(meaning_of(known.measures[name]) if known else ("measure",)))
                for name, (kind, _) in measures.items()
            ],
            "of_measures": [_NOT_MEASURED],
            "cost": [field for field in _COSTS if all(_has(row, field.name) for row in rows)],
        }
    )
    columns: list[Sequence[Any]] = [
        [cell.index for cell in run.cells],
        range(len(rows)),
        *(values for _, values in axes.values()),
        [row.status for row in rows],
        [row.steps for row in rows],
        [_all_passed(judged.get(cell.index, [])) for cell in run.cells],
        [[one.node for one in judged.get(c.index, []) if one.fails] for c in run.cells],
        *(values for _, values in measures.values()),
        [_reasons(row.measures) for row in rows],
    ]
    costs = fields[len(columns) :]
    columns += [[_cost(row, field.name) for row in rows] for field in costs]
    return Table("cells", fields, _batches(fields, columns, len(rows)))


def verdicts_table(run: Run) -> Table:
    """Return the table of verdicts; those on several cells have no cell."""
    checks = run.results().checks
    places = _places(run, checks)
    found = [places.get(check.node) for check in checks]
    order = {cell.index: place for place, cell in enumerate(run.cells)}
    fields = [*key_fields(run), *(field for field in _VERDICT)]
    columns: list[Sequence[Any]] = [
        found,
        [-1 if index is None else order[index] for index in found],
        *([getattr(one, field.name) for one in checks] for field in _VERDICT),
    ]
    return Table("verdicts", fields, _batches(fields, columns, len(checks)))


def _unit_of(experiment: Experiment | None, axis: str, kind: Kind) -> str:
    """Return the unit of an axis of numbers: of all that it varies, where they have the same."""
    if experiment is None or kind not in ("i8", "f8"):
        return ""
    paths = [path for path, name in experiment.swept.items() if name == axis]
    units = {unit_at(experiment.config, path) for path in paths}
    return units.pop() if len(units) == 1 else ""


def _places(run: Run, checks: Sequence[Verdict]) -> dict[str, int]:
    """Return the cell of each claim that is on one cell alone, by its node."""
    if not run.not_understood:
        return cells_of_claims(run.experiment)
    by_label = {cell.label: cell.index for cell in run.cells}
    where = {one.node: one.node.removeprefix(one.name).removeprefix(" at ") for one in checks}
    return {node: by_label[label] for node, label in where.items() if label in by_label}


def _batches(
    fields: Sequence[Field], columns: Sequence[Sequence[Any]], rows: int
) -> Callable[[], Iterator[Batch]]:
    def batches() -> Iterator[Batch]:
        for start in range(0, rows, ROWS_AT_ONCE):
            part = slice(start, start + ROWS_AT_ONCE)
            yield {f.name: list(c[part]) for f, c in zip(fields, columns, strict=True)}

    return batches


def _typed(values: Sequence[Any]) -> tuple[Kind, Sequence[Any]]:
    """Return the narrowest kind that has all of the values, and them as it has them."""
    there = [value for value in values if value is not None]
    if there and all(isinstance(value, bool) for value in there):
        return "bool", values
    if there and all(type(value) is int and abs(value) < 2**63 for value in there):
        return "i8", values
    if all(map(_is_number, there)):
        return "f8", [None if value is None else float(value) for value in values]
    if all(_is_row(value) for value in there):
        return "numbers", [None if v is None else list(map(float, v)) for v in values]
    if all(_is_row(v) or _is_number(v) for v in there):  # a row of one is a number
        rows = [v if v is None or _is_row(v) else [v] for v in values]
        return "numbers", [None if v is None else list(map(float, v)) for v in rows]
    return "text", [None if value is None else str(value) for value in values]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | Fraction) and not isinstance(value, bool)


def _is_row(value: Any) -> bool:
    return isinstance(value, list | tuple) and all(map(_is_number, value))


def _number(value: Any) -> Any:
    """Return what was measured; None for a sentence that says why there is no number."""
    if isinstance(value, list):
        return [_number(item) for item in value]
    return None if isinstance(value, str) else value


def _reasons(measures: Mapping[str, Any]) -> list[str]:
    return [f"{name}: {value}" for name, value in measures.items() if isinstance(value, str)]


def _all_passed(checks: Sequence[Verdict]) -> bool | None:
    judged = [check for check in checks if check.judged]
    return all(check.passed for check in judged) if judged else None


def _has(row: CellResult, name: str) -> bool:
    """Whether a row has a cost; older versions wrote fewer."""
    return name in row.violations or name in CellResult.__dataclass_fields__


def _cost(row: CellResult, column: str) -> Any:
    """Return the cost that a column is of, whose name may have been taken by a measure."""
    name = column if _has(row, column) else column.removeprefix("cost_")
    return row.violations[name] if name in row.violations else getattr(row, name)
