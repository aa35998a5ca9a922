"""`lavender merge`: makes a run of what workers ran into one folder, and judges it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lavender_cli import printing, progress
from lavender_cli.run import Runs, print_finished

if TYPE_CHECKING:
    from lavendersim.runner.merge import Missing

CELLS_NAMED = 10  # of those that are missing


def merge(
    into: Annotated[Path, typer.Argument(metavar="DIR", help="What `lavender run --into` filled.")],
    runs: Runs = Path("runs"),
    plot: Annotated[bool, typer.Option("--plot", help="Draw the figures afterwards.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> None:
    """Make a run of the shards in a folder: one directory, judged and drawn.

    Exits 1 when a check fails, 3 when cells are missing; what is there stays.
    """
    from lavendersim.runner.merge import Missing, experiment_of, merge
    from lavendersim.runner.shards import shards_in

    shards = shards_in(into)
    name = experiment_of(shards[0]).name if shards else into.name
    with progress.reporting(name) as shown:
        found = merge(into, runs, shown)
    if isinstance(found, Missing):
        _say_what_is_missing(into, found)
        raise typer.Exit(printing.DAMAGED)
    printing.warn_of_not_converged(found)
    figures = []
    if plot and found.run.experiment.is_drawn:
        from lavendersim.figures import draw

        figures = draw(found.run, found.run.path / "figures")
    if as_json:
        results = found.run.results().as_json
        printing.as_json([{**results, "run": found.run.path, "figures": figures}])
    else:
        print_finished(found)
        for figure in figures:
            typer.echo(f"  figure {figure}")
    if not found.good:
        raise typer.Exit(1)


def _say_what_is_missing(into: Path, missing: Missing) -> None:
    for sentence in missing.damaged:
        typer.echo(f"{sentence}; delete it, and its cell is run again", err=True)
    for label in missing.cells[:CELLS_NAMED]:
        typer.echo(f"missing: {label}", err=True)
    if len(missing.cells) > CELLS_NAMED:
        typer.echo(f"and {len(missing.cells) - CELLS_NAMED} more", err=True)
    running = f", {missing.running} of them are being run" if missing.running else ""
    typer.echo(
        f"{into}: {len(missing.cells)} of {missing.total} cells are missing{running}; "
        f"go on with: lavender run CONFIG --into {into}",
        err=True,
    )
