"""`lavender plan`: a config in; which effects its scene calls for, and why, out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from lavender_cli import printing


def plan(
    config: Annotated[Path, typer.Argument(help="Config file.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the plan as JSON.")] = False,
) -> None:
    """Show which effects a scene calls for and why; for a sweep, the union over its cells."""
    from lavendersim.experiment import load_experiment
    from lavendersim.scene.plan import plan_of, union

    experiment = load_experiment(config)
    whole = union(plan_of(cell.resolved) for cell in experiment.cells())
    if as_json:
        decisions: dict[str, Any] = {
            name: decision._asdict() for name, decision in whole.decisions.items()
        }
        printing.as_json({"spec": whole.spec._asdict(), "effects": decisions})
        return
    for name, decision in whole.decisions.items():
        word = typer.style("on ", fg=typer.colors.GREEN) if decision.on else "off"
        typer.echo(f"{word}  {name:15} {decision.reason}")
    typer.echo(f"shape pairs: {', '.join(whole.spec.shape_pairs) or 'none'}")
    typer.echo(f"solver: {whole.spec.solver}")
