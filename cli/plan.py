"""`lavender plan`: a config in; which effects its scene calls for, and why, out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing


def plan(
    config: Annotated[Path, typer.Argument(help="Config file.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print the plan as JSON.")] = False,
) -> None:
    """Show which effects a scene calls for and why; for a sweep, the union over its cells.

    Cells that differ in a choice between laws, such as the solver, share no union: one plan each.
    """
    from lavendersim.experiment import load_experiment
    from lavendersim.runner.plans import distinct, shared_plans
    from lavendersim.scene.plan import CHOICES

    plans = distinct(shared_plans(cell.resolved for cell in load_experiment(config).cells()))
    if as_json:
        tables = [
            {
                "spec": one.spec._asdict(),
                "effects": {name: item._asdict() for name, item in one.decisions.items()},
            }
            for one in plans
        ]
        printing.as_json({**tables[0], "others": tables[1:]})
        return
    for number, one in enumerate(plans):
        if number:
            typer.echo()
        for name, decision in one.decisions.items():
            word = typer.style("on ", fg=typer.colors.GREEN) if decision.on else "off"
            typer.echo(f"{word}  {name:15} {decision.reason}")
        typer.echo(f"shape pairs: {', '.join(one.spec.shape_pairs) or 'none'}")
        for name, choice in zip(CHOICES, one.choices, strict=True):
            typer.echo(f"{name}: {choice}")
