"""The prices of a run enter, a table for people leaves: what each effect costs, off and on."""

from __future__ import annotations

from typing import Any

import typer

HEADER = ("effect", "scene calls", "off", "on", "price", "interval", "compile off/on s", "")


def print_table(run: Any) -> None:
    """Print what each effect costs, where the run has prices; nothing where it has none."""
    prices = run.results().get("prices")
    if prices is None:
        return
    typer.echo(
        f"  prices in ns per body (/b) or contact (/c) and step: {prices['bodies']} movable "
        f"{'body' if prices['bodies'] == 1 else 'bodies'}, {prices['contacts_per_step']:.3g} "
        f"contacts a step, {prices['steps']} steps; medians of {prices['repeats']} repeats, "
        f"interval: where the median lies in 19 of 20 cases; {prices['processor']}"
    )
    rows = [HEADER, *(_cells(row) for row in prices["rows"])]
    widths = [max(len(row[column]) for row in rows if len(row) > 3) for column in range(7)]
    for row in rows:
        if len(row) == 3:  # no price, and why
            typer.echo(f"  {row[0]:{widths[0]}}  {row[1]:{widths[1]}}  {row[2]}")
            continue
        numbers = "  ".join(f"{row[column]:>{widths[column]}}" for column in range(2, 7))
        typer.echo(f"  {row[0]:{widths[0]}}  {row[1]:{widths[1]}}  {numbers}  {row[7]}".rstrip())


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    called = "yes" if row["called_for"] else "no"
    if row["why_not"]:
        return (row["effect"], called, row["why_not"])
    price = row["price"]
    return (
        row["effect"],
        called,
        _short(row["off"]["median"]),
        _short(row["on"]["median"]),
        f"{_short(price['median'])} /{row['unit'][0]}",
        f"{_short(price['low'])} to {_short(price['high'])}",
        f"{row['compile_s_off']:.1f}/{row['compile_s_on']:.1f}",
        ", ".join(_notes(row)),
    )


def _notes(row: dict[str, Any]) -> list[str]:
    notes = ["within noise"] if row["within_noise"] else []
    if not row["same_motion"]:
        contacts = f"{row['contacts_off']:.3g} and {row['contacts_on']:.3g} contacts a step"
        notes.append(f"another motion without it: {contacts}")
    if row["on_top_of"]:
        notes.append(f"on top of {', '.join(row['on_top_of'])}")
    return notes


def _short(value: float) -> str:
    """Return nanoseconds to a tenth, whole above a thousand."""
    value = round(value, 1) + 0.0  # no -0.0
    return f"{value:.0f}" if abs(value) >= 1000.0 else f"{value:.1f}"
