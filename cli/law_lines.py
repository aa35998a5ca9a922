"""What the steps of a log do to each law of contact, in lines: the worst, with its bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from lavender_cli.printing import digits

if TYPE_CHECKING:
    from lavendersim.laws.judging import JudgedLaws, WorstStep


def print_laws(judged: JudgedLaws, title: str) -> None:
    """Print a line for each law, and which is broken most."""
    from lavendersim.laws.step_laws import MEANINGS

    counted = f"{len(judged.steps)} steps"
    if judged.left_out:
        counted += f", {judged.left_out} left out that an event opens"
    typer.echo(f"{typer.style(title, bold=True)}  {counted}")
    for one in judged.worst:
        text = _worst(one) if one.bodies else "0"
        typer.echo(f"  {one.law:<16} {text:<58}  {MEANINGS[one.law]}")
    named = judged.named
    if named is None:
        typer.echo("  none of them is broken beyond 1e-4 of what is at play")
    else:
        share = float(judged.shares[named.law].max())
        typer.echo(f"  broken most: {named.law}, by {digits(share)} of what is at play")


def _worst(one: WorstStep) -> str:
    from lavendersim.laws.step_laws import UNITS

    violation = one.violation
    text = f"{digits(violation.number)} {UNITS[one.law]}"
    if violation.velocity:
        text += f" ({digits(violation.velocity)} m/s)"
    if violation.gap:
        text += f" across {digits(violation.gap)} m"
    return f"{text}, {' and '.join(one.bodies)}, step {one.step}, t = {digits(one.time)} s"


def print_steps(judged: JudgedLaws) -> None:
    """Print the numbers of every step."""
    from lavendersim.laws.step_laws import UNITS

    columns = [f"{law} [{unit}]" for law, unit in UNITS.items()]
    typer.echo("  ".join(["step".rjust(8), *(one.rjust(22) for one in columns)]))
    for k, step in enumerate(judged.steps):
        numbers = (digits(float(judged.numbers[law][k])) for law in UNITS)
        typer.echo("  ".join([str(int(step)).rjust(8), *(one.rjust(22) for one in numbers)]))
