"""`lavender check`: configs in, one line per judged expectation and cell out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import printing
from lavender_cli.run import Configs, Jobs, Runs


def check(
    configs: Configs,
    jobs: Jobs = 1,
    runs: Runs = Path("runs"),
    full: Annotated[
        bool, typer.Option("--full", help="Run slow experiments in full, not reduced.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdicts as JSON.")] = False,
) -> None:
    """Run experiments and print every verdict, cell by cell. Exits 1 when one fails."""
    from lavendersim.runner import load_all, run

    experiments = load_all(configs, reduced=not full)
    good, verdicts, cells = True, [], []
    for experiment in experiments:
        with printing.reporting(experiment.name) as progress:
            finished = run(experiment, runs, jobs, progress, prices=False)
        good = good and finished.good
        printing.warn_of_unsolved(finished)
        cells += [
            {"experiment": experiment.name, "cell": cell.label, "status": cell.status}
            for cell in finished.run.cells
        ]
        verdicts += [
            {"experiment": experiment.name, **verdict._asdict()} for verdict in finished.verdicts
        ]
        if as_json:
            continue
        for verdict in finished.verdicts:
            typer.echo(
                f"{printing.mark(verdict.passed)}  {experiment.name}: {verdict.node}: "
                f"{printing.digits(verdict.measured)}, expected {verdict.expected}"
            )
        printing.print_failures(finished)
    if as_json:
        printing.as_json({"passed": good, "cells": cells, "verdicts": verdicts})
    else:
        passed = sum(bool(verdict["passed"]) for verdict in verdicts)
        ended = sum(cell["status"] == "complete" for cell in cells)
        typer.echo(
            f"{passed} of {len(verdicts)} expectations met, {ended} of {len(cells)} cells complete"
        )
    if not good:
        raise typer.Exit(1)
