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
    """List runs, oldest first. Exits 3 when a finished one has a damaged table or a cut log."""
    from lavendersim.runner import list_runs

    rows = [_row(run) for run in list_runs(runs)]
    if as_json:
        printing.as_json(rows)
        _end(rows)
        return
    if not rows:
        typer.echo(f"{runs} holds no run", err=True)
    for row in rows:
        state = printing.mark(bool(row["passed"])) if row["finished"] else "----"
        if row["damaged"]:
            word = "BAD " if row["passed"] is None else "CUT "
            state = typer.style(word, fg=typer.colors.RED, bold=True)
        typer.echo(f"{state}  {row['path']}")
    _end(rows)


def _row(run: Any) -> dict[str, Any]:
    """Return what there is to say of a run; one with a damaged table is not in the others' way."""
    from lavendersim.errors import TraceError

    passed: bool | None = None
    damaged: list[str] = []
    if run.finished:  # another is listed as such; its logs are as they were left
        try:
            passed = run.results()["passed"]
            damaged = run.cut()
        except TraceError as error:
            damaged = [str(error)]
    return {"path": run.path, "finished": run.finished, "passed": passed, "damaged": damaged}


def _end(rows: list[dict[str, Any]]) -> None:
    """Say which logs were cut and which tables are damaged, and exit 3 where one is."""
    damaged = [sentence for row in rows for sentence in row["damaged"]]
    printing.report_damage(damaged)
    if damaged:
        raise typer.Exit(printing.DAMAGED)
