"""The table of a run's overheads: what each effect costs a step, off and on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from lavendersim.measures.overhead_table import OverheadRow, OverheadTiming

HEADER = ("effect", "required", "off", "on", "overhead", "interval", "compile off/on s", "")


def print_table(run: Any) -> None:
    """Print what each effect costs, where the run has overheads; nothing where it has none."""
    overheads = run.overheads()
    if overheads is None:
        return
    only = " of the effects that the scene requires" if overheads.only_required else ""
    typer.echo(
        f"  overheads{only} in ns per body (/b) or contact (/c) and step: {overheads.bodies} "
        f"movable {'body' if overheads.bodies == 1 else 'bodies'}, "
        f"{overheads.contacts_per_step:.3g} contacts a step, {overheads.steps} steps; "
        f"medians of {overheads.repeats} repeats, interval: where the median lies in 19 of 20 "
        f"cases; {overheads.processor}"
    )
    if overheads.interrupted:
        typer.echo(f"  {overheads.interrupted}")
    if not overheads.rows:
        return
    rows = [HEADER, *(_cells(row) for row in overheads.rows)]
    widths = [max(len(row[column]) for row in rows if len(row) > 3) for column in range(7)]
    for row in rows:
        if len(row) == 3:  # no overhead, and why
            typer.echo(f"  {row[0]:{widths[0]}}  {row[1]:{widths[1]}}  {row[2]}")
            continue
        numbers = "  ".join(f"{row[column]:>{widths[column]}}" for column in range(2, 7))
        typer.echo(f"  {row[0]:{widths[0]}}  {row[1]:{widths[1]}}  {numbers}  {row[7]}".rstrip())


def raise_interrupted(run: Any) -> None:
    """Raise KeyboardInterrupt where a signal ended the rounds of a run's overheads."""
    overheads = run.overheads()
    if overheads is not None and overheads.interrupted:
        raise KeyboardInterrupt(overheads.interrupted)


def _cells(row: OverheadRow) -> tuple[str, ...]:
    required = "yes" if row.required else "no"
    if (timing := row.timing) is None:
        return (row.effect, required, row.why_not)
    overhead = timing.overhead
    return (
        row.effect,
        required,
        _short(timing.off.median),
        _short(timing.on.median),
        f"{_short(overhead.median)} /{row.unit[0]}",
        f"{_short(overhead.low)} to {_short(overhead.high)}",
        f"{timing.compile_s_off:.1f}/{timing.compile_s_on:.1f}",
        ", ".join(_notes(row, timing)),
    )


def _notes(row: OverheadRow, timing: OverheadTiming) -> list[str]:
    notes = ["within noise"] if timing.within_noise else []
    if not timing.same_motion:
        contacts = f"{timing.contacts_off:.3g} and {timing.contacts_on:.3g} contacts a step"
        notes.append(f"another motion without it: {contacts}")
    if row.on_top_of:
        notes.append(f"on top of {', '.join(row.on_top_of)}")
    return notes


def _short(value: float) -> str:
    """Return nanoseconds to a tenth, whole above a thousand."""
    value = round(value, 1) + 0.0  # no -0.0
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.1f}"
