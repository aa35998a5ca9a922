"""The cells of a run in lines: a line for each of a few, of many the counts, ranges and worst."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import typer

from lavender_cli.printing import CELLS_SHOWN, digits, mark

if TYPE_CHECKING:
    from lavendersim.runner.run_results import CellResult

ENDED_SHOWN: Final = 5
NO_RESIDUAL: Final = "residual not recorded"  # by other engines, and versions before 0.1.0
_SINGLE: Final = (int, float, str)  # not a row of numbers


def print_cells(rows: Sequence[CellResult], verbose: bool) -> None:
    """Print the cells of a run: each of up to CELLS_SHOWN or where verbose, else all together."""
    if verbose or len(rows) <= CELLS_SHOWN:
        for row in rows:
            typer.echo(line_of(row))
        return
    for line in summary_of(rows):
        typer.echo(f"  {line}")
    typer.echo("  -v lists each cell, results.csv has them as a table")


def line_of(row: CellResult) -> str:
    """Return the line of a cell."""
    numbers = ", ".join(
        f"{name} {digits(value)}"
        for name, value in row.measures.items()
        if isinstance(value, float | int) and math.isfinite(value)
    )
    return (
        f"  {row.index:4}  {row.label or '-'}  {row.status}  "
        f"physics {row.physics_us_per_step:.2f} us/step  {accuracy(row)}  {numbers}"
    )


def summary_of(rows: Sequence[CellResult]) -> list[str]:
    """Return lines of many cells: how they ended, cost, accuracy, and of each measure the range."""
    ended = [row for row in rows if row.status != "complete"]
    lines = [f"{len(rows) - len(ended)} of {len(rows)} complete"]
    lines += [f"{mark(False)}  {row.label}: {row.status}" for row in ended[:ENDED_SHOWN]]
    if len(ended) > ENDED_SHOWN:
        lines.append(f"and {len(ended) - ENDED_SHOWN} more ended early")
    costs = [(row.physics_us_per_step, row.label) for row in rows]
    lines += _range("physics", costs, " us/step")
    recorded = [row for row in rows if row.not_converged_steps is not None]
    if recorded:
        worst = max(recorded, key=_residual)
        lines.append(f"residual <= {digits(worst.worst_residual)} m/s, largest at {worst.label}")
    else:
        lines.append(NO_RESIDUAL)
    missed = [(row.not_converged_steps, row) for row in recorded if row.not_converged_steps]
    if missed:
        count, most = max(missed, key=lambda one: one[0] / max(one[1].steps, 1))
        steps = sum(count for count, _ in missed)
        lines.append(
            f"{steps} steps of {len(missed)} cells above the tolerance, most at "
            f"{most.label}: {count} of {most.steps}"
        )
    counts: Counter[str] = Counter()
    for row in rows:
        counts.update(row.at_limit)
    if counts:
        lines.append(_limits(counts))
    for name in dict.fromkeys(name for row in rows for name in row.measures):
        lines += _range(name, [(row.measures.get(name), row.label) for row in rows])
    return lines


def _limits(counts: Mapping[str, int]) -> str:
    from lavendersim.runner.limits_reached import limits_in_words  # late: `ls` reads no results

    return limits_in_words(counts)


def _residual(row: CellResult) -> float:
    """Return the worst residual of a cell; one that is not a number is the largest of all."""
    return math.inf if math.isnan(row.worst_residual) else row.worst_residual


def _range(name: str, taken: Sequence[tuple[Any, str]], unit: str = "") -> list[str]:
    """Return the least and the greatest of a number and where they are; and how many have none.

    taken: of each cell, with its label. A measure that gives a row of numbers has no range.
    """
    alone = [(_number(value), place) for value, place in taken if isinstance(value, _SINGLE)]
    found = [(value, place) for value, place in alone if not math.isnan(value)]
    lines = []
    if found:
        low, high = min(found), max(found)
        ends = [f"{digits(value)}{unit} at {place}" for value, place in (low, high)]
        is_same = low[0] == high[0]
        lines.append(
            f"{name}  {digits(low[0])}{unit}" if is_same else f"{name}  {' to '.join(ends)}"
        )
    if len(found) < len(alone):
        lines.append(f"{name}  not a number in {len(alone) - len(found)} of {len(taken)} cells")
    return lines


def _number(value: float | str) -> float:
    """Return a number of the results; NaN for a text, which says why there is none."""
    return math.nan if isinstance(value, str) else float(value)


def accuracy(row: CellResult) -> str:
    """Return how far the steps of a cell were solved, in words."""
    known = row.not_converged_steps is not None
    worst = f"residual <= {digits(row.worst_residual)} m/s" if known else NO_RESIDUAL
    if row.at_limit:
        worst += f"  {_limits(row.at_limit)}"
    if not row.not_converged_steps:
        return worst
    tolerance = f"tolerance {digits(row.tolerance)} m/s"
    return f"{worst} ({row.not_converged_steps} of {row.steps} steps above the {tolerance})"
