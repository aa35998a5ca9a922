"""`lavender replay`: shows a cell in rerun's viewer, or writes a recording or a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import AllowIncomplete, Runs


def replay(
    run: Annotated[
        Path | None,
        typer.Argument(metavar="[RUN]", help="Run directory; the latest finished run by default."),
    ] = None,
    cell: Annotated[
        int | None,
        typer.Option("--cell", metavar="K", help="Which cell of the sweep, counted from 0."),
    ] = None,
    at: Annotated[
        float | None,
        typer.Option("--at", metavar="SECONDS", help="Stop at this simulated time."),
    ] = None,
    runs: Runs = Path("runs"),
    save_to: Annotated[
        Path | None,
        typer.Option("--save", metavar="FILE.rrd", help="Write a rerun recording; open nothing."),
    ] = None,
    screenshot_to: Annotated[
        Path | None,
        typer.Option(
            "--screenshot",
            metavar="FILE.png",
            help="Write a picture of the viewer at --at or the last contact; needs no display.",
        ),
    ] = None,
    allow_incomplete: AllowIncomplete = False,
) -> None:
    """Replay a run in rerun: bodies, contact forces and their plots over simulated time.

    Exits 3 when its log is damaged.
    """
    from lavendersim import replay as viewer
    from lavendersim.errors import UsageError
    from lavendersim.runner import open_run

    for path, suffix in ((save_to, ".rrd"), (screenshot_to, ".png")):
        if path is not None and path.suffix != suffix:
            raise UsageError(f"{path}: the name of this file ends in {suffix}")
    if save_to is not None and at is not None and screenshot_to is None:
        raise UsageError("--at: an .rrd file has no place for it; leave out --save or --at")
    opened = open_run(run, runs, allow_incomplete)
    cells = opened.cells
    if not 0 <= (cell or 0) < len(cells):
        raise UsageError(f"{opened.path} has cells 0 to {len(cells) - 1}; there is no cell {cell}")
    chosen = cells[cell or 0]
    if cell is None and len(cells) > 1:
        others = f"0 to {len(cells) - 1}"
        typer.echo(f"replaying cell 0 ({chosen.label}); --cell K shows another, {others}", err=True)

    damaged = list(filter(None, [chosen.damage()]))
    printing.report_damage(damaged, "nothing is shown" if not allow_incomplete else "")
    trace = chosen.trace()
    part = f"(INCOMPLETE: {len(trace.step)} steps are whole)" if damaged else ""
    title = " ".join(filter(None, [opened.path.name, chosen.label, part]))
    if save_to is not None:
        viewer.save(trace, save_to, title)
        typer.echo(save_to)
    if screenshot_to is not None:
        for complaint in viewer.screenshot(trace, screenshot_to, title, at):
            typer.echo(f"rerun's viewer: {complaint}", err=True)
        typer.echo(screenshot_to)
    if save_to is None and screenshot_to is None:
        viewer.open_viewer(trace, title, at)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
