"""`lavender ls`: lists the runs of a folder, a line each."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lavender_cli import printing
from lavender_cli.run import Runs


def ls(
    runs: Runs = Path("runs"),
    as_json: Annotated[bool, typer.Option("--json", help="Print the runs as JSON.")] = False,
) -> None:
    """List runs, oldest first. Exits 3 when a finished one has a log that was cut."""
    from lavendersim.runner import list_runs

    rows: list[dict[str, Any]] = []
    for run in list_runs(runs):
        passed = run.results()["passed"] if run.finished else None
        # An unfinished one is listed as such; its logs are as they were left.
        cut = run.cut() if run.finished else []
        row = {"path": run.path, "finished": run.finished, "passed": passed, "damaged": cut}
        rows.append(row)
    if as_json:
        printing.as_json(rows)
        _end(rows)
        return
    if not rows:
        typer.echo(f"{runs} holds no run", err=True)
    for row in rows:
        state = printing.mark(bool(row["passed"])) if row["finished"] else "----"
        if row["damaged"]:
            state = typer.style("CUT ", fg=typer.colors.RED, bold=True)
        typer.echo(f"{state}  {row['path']}")
    _end(rows)


def _end(rows: list[dict[str, Any]]) -> None:
    """Say which logs were cut, and exit 3 where one was."""
    damaged = [sentence for row in rows for sentence in row["damaged"]]
    printing.report_damage(damaged)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
