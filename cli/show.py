"""`lavender show`: a run in; its question, plan, cells, measures and verdicts out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

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
    steps = sum(row["steps"] for row in results["cells"])
    logging = sum(row["steps"] * row["logging_us_per_step"] for row in results["cells"])
    compiling = f"compile {results.get('compile_s', float('nan')):.1f} s"
    typer.echo(f"cells  logging {logging / max(steps, 1):.2f} us/step, {compiling}")
    for row in results["cells"]:
        numbers = ", ".join(
            f"{name} {printing.digits(value)}"
            for name, value in row["measures"].items()
            if isinstance(value, float | int)
        )
        typer.echo(
            f"  {row['index']:4}  {row['label'] or '-'}  {row['status']}  "
            f"physics {row['physics_us_per_step']:.2f} us/step  {accuracy(row)}  {numbers}"
        )
    typer.echo("checks")
    for verdict in results["checks"]:
        typer.echo(f"  {printing.mark(verdict['passed'])}  {verdict['node']}")


def accuracy(row: dict[str, Any]) -> str:
    """Return how far the steps of a cell were solved, in words; nothing for runs of old."""
    if "worst_residual" not in row:
        return ""
    worst = f"residual <= {printing.digits(float(row['worst_residual']))} m/s"
    if not row["unsolved_steps"]:
        return worst
    asked = f"tolerance {printing.digits(row['tolerance'])} m/s"
    return f"{worst} ({row['unsolved_steps']} of {row['steps']} steps above the {asked})"
