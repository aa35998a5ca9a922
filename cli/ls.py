"""`lavender ls`: lists the runs of a folder, a line each."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import Runs


def ls(
    runs: Runs = Path("runs"),
    as_json: Annotated[bool, typer.Option("--json", help="Print the runs as JSON.")] = False,
) -> None:
    """List runs, oldest first."""
    from lavendersim.runner import list_runs

    rows = []
    for run in list_runs(runs):
        passed = run.results()["passed"] if run.finished else None
        rows.append({"path": run.path, "finished": run.finished, "passed": passed})
    if as_json:
        printing.as_json(rows)
        return
    if not rows:
        typer.echo(f"{runs} holds no run", err=True)
    for row in rows:
        state = printing.mark(bool(row["passed"])) if row["finished"] else "----"
        typer.echo(f"{state}  {row['path']}")
