"""`lavender plot`: draws the figures of runs from their logs alone."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import AllowIncomplete, LatestRuns, Own, Runs


def plot(
    runs: LatestRuns = None,
    root: Runs = Path("runs"),
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Instead of the run's own figures/."),
    ] = None,
    allow_incomplete: AllowIncomplete = False,
    own: Own = None,
) -> None:
    """Draw the figure of each run as PNG and SVG. Exits 3 when a log is damaged."""
    from lavendersim.errors import UsageError
    from lavendersim.figures import draw
    from lavendersim.runner import open_run

    named: list[Path | None] = [*runs] if runs else [None]
    chosen = [open_run(path, root, allow_incomplete) for path in named]
    damaged = [sentence for run in chosen for sentence in run.damaged()]
    printing.report_damage(damaged, "nothing is drawn" if not allow_incomplete else "")
    for run in chosen:
        if not run.experiment.is_drawn and run.cost() is None:
            raise UsageError(f"{run.path}: its config has no figure section")
        for figure in draw(run, output or run.path / "figures"):
            typer.echo(figure)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
