"""What `--refine` prints: how far each measure is from where smaller timesteps lead it."""

from __future__ import annotations

from math import isfinite, isnan
from typing import Any

import typer

from lavender_cli.printing import FAILURES_SHOWN, digits

HEADER = ("measure", "h", "h/2", "h/4", "order", "at h = 0", "time error", "cell")


def refine(finished: Any, jobs: int) -> list[Any]:
    """Run the cells at finer timesteps and return what that shows; printed while it goes on."""
    from lavender_cli import progress
    from lavendersim.runner.refinement import refine as refined

    return refined(finished, jobs, progress.reporting)


def print_table(refined: list[Any]) -> None:
    """Print of each measure the cell with the largest time error, and what a claim forbids."""
    rows = list(_worst(refined).values())
    typer.echo("  time error: every cell again at half and a quarter of its timestep h")
    table = [HEADER, *(_cells(row) for row in rows)]
    widths = [max(len(line[column]) for line in table) for column in range(len(HEADER) - 1)]
    for line in table:
        numbers = "  ".join(f"{line[column]:>{widths[column]}}" for column in range(1, len(widths)))
        typer.echo(f"  {line[0]:{widths[0]}}  {numbers}  {line[-1]}".rstrip())
    exceeding = [row for row in refined if row.exceeds]
    for row in exceeding[:FAILURES_SHOWN]:
        typer.echo(f"  {typer.style('time error', fg=typer.colors.YELLOW)}  {sentence(row)}")
    if len(exceeding) > FAILURES_SHOWN:
        more = len(exceeding) - FAILURES_SHOWN
        typer.echo(f"  and {more} more whose change exceeds the claim's tolerance")
    if refined:
        typer.echo("  all cells and measures: time_errors.csv in the run's directory")


def sentence(row: Any) -> str:
    """Say of a measure that changes by more than a claim leaves, where, and by how much."""
    where = f" at {row.cell.label}" if row.cell.label else ""
    if isnan(row.found.change):
        return f"{row.measure}{where}: {row.found.note}; {row.claim!r} claims a number"
    return (
        f"{row.measure}{where}: half the timestep changes it by {digits(abs(row.found.change))}, "
        f"{row.claim!r} leaves {digits(row.tolerance)}"
    )


def as_table(refined: list[Any]) -> list[dict[str, Any]]:
    """Return what was found for JSON: numbers that are none become null."""
    return [
        {
            "measure": row.measure,
            "cell": row.cell.label,
            "values": [_number(value) for value in row.found.values],
            "change": _number(row.found.change),
            "order": _number(row.found.order),
            "extrapolated": _number(row.found.extrapolated),
            "bar": _number(row.found.bar),
            "error": _number(row.found.error),
            "tolerance": row.tolerance,
            "exceeds": row.exceeds,
            "note": row.found.note,
        }
        for row in refined
    ]


def _number(value: float) -> float | None:
    return value if isfinite(value) else None


def _worst(refined: list[Any]) -> dict[str, Any]:
    """Return of each measure the row to show: the largest time error, those without one last."""
    worst: dict[str, Any] = {}
    for row in refined:
        if row.measure not in worst or _size(row) > _size(worst[row.measure]):
            worst[row.measure] = row
    return worst


def _size(row: Any) -> float:
    size = max(abs(row.found.error), row.found.bar)
    return -1.0 if isnan(size) else size


def _cells(row: Any) -> tuple[str, ...]:
    found = row.found
    if not found.values:
        return (row.measure, *("-",) * 6, f"{row.cell.label}  ({found.note})".strip())
    order = "-" if isnan(found.order) else f"{found.order:.2f}"
    zero = f"{digits(found.extrapolated)} +- {found.bar:.1g}"
    note = f"{row.cell.label}  ({found.note})" if found.note else row.cell.label
    values = tuple(digits(value) for value in found.values)
    return (row.measure, *values, order, zero, f"{found.error:.2g}", note.strip())
