"""`lavender judge`: measures and judges a run again from its logs, or the laws of every step."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lavender_cli import claims, law_lines, printing
from lavender_cli.run import Own, Runs, run_names

if TYPE_CHECKING:
    from lavendersim.laws.motion import RecordedMotion
    from lavendersim.runner import RunCell

RunOrLog = Annotated[
    Path | None,
    typer.Argument(
        metavar="[RUN]",
        help="Run directory, the latest by default; with --laws also a log, of any program.",
        autocompletion=run_names,
    ),
]


def judge(
    run: RunOrLog = None,
    runs: Runs = Path("runs"),
    own: Own = None,
    verbose: claims.Verbose = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the verdicts as JSON.")] = False,
    laws: Annotated[
        bool,
        typer.Option(
            "--laws",
            help="How far each step breaks the laws of contact, by poses and velocities; "
            "with -v every step.",
        ),
    ] = False,
) -> None:
    """Measure and judge a run again from its logs alone; it may be one that was killed.

    With --laws instead: the impulses within Coulomb's cone that explain each step best, and what
    is left. Exits 1 when a check fails, 3 when a log is damaged.
    """
    if laws:
        _judge_laws(run, runs, verbose, as_json)
        return
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


def _judge_laws(run: Path | None, runs: Path, verbose: bool, as_json: bool) -> None:
    from lavendersim.errors import UsageError
    from lavendersim.laws.judging import judge_laws
    from lavendersim.laws.motion import read_motion
    from lavendersim.runner import open_run

    found: list[dict[str, Any]] = []
    if run is not None and run.suffix == ".mcap":
        taken: list[tuple[str, Callable[[], RecordedMotion]]] = [
            (run.name, partial(read_motion, run))
        ]
    else:
        cells = open_run(run, runs).cells
        taken = [(_title(cell), partial(_motion, cell)) for cell in cells]
    refused: list[UsageError] = []
    for title, motion in taken:
        try:
            judged = judge_laws(motion())
        except UsageError as error:  # its log has no velocities; those of other engines have them
            refused.append(error)
            typer.echo(f"{title}: not judged: {error}", err=True)
            continue
        if as_json:
            found.append({"cell": title, **judged.table(), **(judged.rows() if verbose else {})})
        else:
            law_lines.print_laws(judged, title)
            if verbose:
                law_lines.print_steps(judged)
    if as_json:
        printing.as_json({"cells": found})
    if len(refused) == len(taken):
        raise typer.Exit(UsageError.exit_code)


def _motion(cell: RunCell) -> RecordedMotion:
    from lavendersim.laws.motion import motion_of

    return motion_of(cell.trace())


def _title(cell: RunCell) -> str:
    return cell.label or cell.path.stem
