"""`lavender show`: a run in; its question, plan, cells, measures and verdicts out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import Runs


def show(
    run: Annotated[
        Path | None, typer.Argument(metavar="[RUN]", help="Run directory; the latest by default.")
    ] = None,
    runs: Runs = Path("runs"),
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
) -> None:
    """Show what a run asked, which effects it simulated, what it measured and how it was judged."""
    from lavendersim.runner import open_run

    opened = open_run(run, runs)
    results = opened.results()
    if as_json:
        printing.as_json(results)
        return
    experiment = opened.experiment
    typer.echo(f"{typer.style(opened.name, bold=True)}  {opened.path}")
    for name, text in (("question", experiment.question), ("expected", experiment.expected)):
        if text:
            typer.echo(f"{name}  {text}")
    typer.echo("plan")
    for name, reason in opened.cells[0].trace().metadata.get("plan", {}).items():
        typer.echo(f"  {name:15} {reason}")
    typer.echo("cells")
    for row in results["cells"]:
        numbers = ", ".join(
            f"{name} {printing.digits(value)}"
            for name, value in row["measures"].items()
            if isinstance(value, float | int)
        )
        typer.echo(f"  {row['index']:4}  {row['label'] or '-'}  {row['status']}  {numbers}")
    typer.echo("checks")
    for verdict in results["checks"]:
        typer.echo(f"  {printing.mark(verdict['passed'])}  {verdict['node']}")
