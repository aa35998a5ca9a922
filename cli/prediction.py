"""What runs will take, printed before the first begins; a long or large one is confirmed."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lavender_cli import printing
from lavender_cli.asking import confirmed

if TYPE_CHECKING:
    from lavendersim.runner.cell_jobs import Prepared
    from lavendersim.runner.prediction import Prediction

VARIABLE = "LAVENDER_YES"
Yes = Annotated[
    bool,
    typer.Option("--yes", "-y", envvar=VARIABLE, help="Begin long or large runs without asking."),
]


def confirm(
    groups: Iterable[Sequence[Any]],
    runs: Path,
    jobs: int,
    yes: bool,
    known: Sequence[Prepared] = (),
) -> None:
    """Say what runs will take where that is long, and ask. UsageError where nobody can be asked.

    groups: for each experiment what is run of it, one after the other. yes: nobody is asked.
    known: those that are planned.
    """
    from lavendersim.errors import UsageError
    from lavendersim.runner.prediction import predicted_together

    found = [one for group in groups if (one := predicted_together(group, runs, jobs, known))]
    for one in found:
        if one.is_worth_saying:
            typer.echo(sentence_of(one), err=True)
    much = [one for one in found if one.is_long or one.space.is_large]
    if not much or yes:
        return
    which = ", ".join(one.name for one in much)
    why = "more than an hour" if any(one.is_long for one in much) else ""
    if any(one.space.is_large for one in much):
        why += " and " * bool(why) + "more than a tenth of the free disk"
    if not _somebody_answers():
        raise UsageError(f"{which}: {why}; nothing has begun: say --yes, or set {VARIABLE}=1")
    if not confirmed(f"{which}: {why}. Begin?", err=True):
        raise UsageError("nothing has begun")


def with_refined(experiment: Any) -> list[Any]:
    """Return what is run of an experiment for its time errors, too: see --refine."""
    from lavendersim.measures.time_errors import DIVISORS

    return [experiment.refined(divisor) for divisor in DIVISORS]


def sentence_of(one: Prediction) -> str:
    """Return what a run will take, in words."""
    cells = f"{one.cells:,} cell{'s' * (one.cells != 1)}, {one.steps:,} steps"
    size, free = one.space
    logs = "" if size is None else f", about {printing.byte_size(size, digits=2)} of logs"
    there = f" ({printing.byte_size(free, digits=2)} are free)" if one.space.is_large else ""
    return f"{one.name}: {cells}{logs}{there}, about {printing.time_span(one.seconds)}"


def _somebody_answers() -> bool:
    return sys.stdin.isatty() and sys.stderr.isatty()
