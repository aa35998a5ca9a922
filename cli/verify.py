"""`lavender verify`: reads all of a run and says what of it is not as it was written."""

from __future__ import annotations

from pathlib import Path

import typer

from lavender_cli import printing
from lavender_cli.run import LatestRuns, Own, Runs


def verify(
    runs: LatestRuns = None,
    root: Runs = Path("runs"),
    own: Own = None,
) -> None:
    """Read every byte of a run: digests, checksums, results measured again from the logs.

    Prints a line for each problem. Exits 3 when there is one.
    """
    from lavendersim.runner import open_run
    from lavendersim.runner.verification import has_digests, problems_of

    named: list[Path | None] = [*runs] if runs else [None]
    whole = True
    for run in [open_run(path, root) for path in named]:
        problems = 0
        for problem in problems_of(run):
            typer.echo(problem)
            problems += 1
        whole = whole and not problems
        if problems:
            continue
        size = printing.byte_size(sum(log.stat().st_size for log in run.logs()))
        logs = f"{len(run.logs())} log{'s' * (len(run.logs()) != 1)}, {size}"
        typer.echo(f"{run.path}: whole: {logs}")
        if not has_digests(run):
            older = (
                "an older version wrote it, without digests: logs were checked against their CRCs"
            )
            typer.echo(f"{run.path}: {older}", err=True)
    if not whole:
        raise typer.Exit(printing.DAMAGED)
