"""`lavender export`: writes a run as tables for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import AllowIncomplete, LatestRun, Runs


def export(
    run: LatestRun = None,
    file_format: Annotated[
        str, typer.Option("--to", metavar="FORMAT", help="parquet, csv or arrow.")
    ] = "parquet",
    tables: Annotated[
        str | None,
        typer.Option(
            "--table",
            metavar="NAME,...",
            help="Of cells, verdicts, step, pose, velocity, contact; all there are by default.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Instead of the run's own export/."),
    ] = None,
    runs: Runs = Path("runs"),
    allow_incomplete: AllowIncomplete = False,
) -> None:
    """Export a run as tables with units: Parquet, CSV or Arrow. Exits 3 when a log is damaged."""
    from lavendersim.runner import open_run
    from lavendersim.runner.export import export_run

    opened = open_run(run, runs, allow_incomplete)
    damaged = opened.damaged()
    printing.report_damage(damaged, "nothing is exported" if not allow_incomplete else "")
    names = None if tables is None else [name.strip() for name in tables.split(",")]
    written = export_run(opened, file_format, output or opened.path / "export", names)
    for sentence in filter(None, (opened.not_understood, *written.left_out)):
        typer.echo(sentence, err=True)
    for file in written.files:
        typer.echo(file)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
