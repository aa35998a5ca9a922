"""`lavender judge`: measures and judges a run again, from its logs alone."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from lavender_cli import claims, printing
from lavender_cli.run import LatestRun, Own, Runs


def judge(
    run: LatestRun = None,
    runs: Runs = Path("runs"),
    own: Own = None,
    verbose: claims.Verbose = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdicts as JSON.")] = False,
) -> None:
    """Measure and judge a run again from its logs alone; it may be one that was killed.

    Exits 1 when a check fails, 3 when a log is damaged.
    """
    from lavendersim.runner import open_run
    from lavendersim.runner.judge_again import judge_again

    opened = open_run(run, runs)
    judged = judge_again(opened)
    if as_json:
        printing.as_json(judged.table())
    else:
        typer.echo(f"{typer.style(opened.name, bold=True)}  {opened.path}")
        claims.print_claims(judged.verdicts, verbose)
        claims.print_failures(judged.ended_early, judged.verdicts, verbose)
    printing.report_damage(judged.damaged)
    if judged.damaged:
        raise typer.Exit(printing.DAMAGED)
    if not judged.good:
        raise typer.Exit(1)
