"""`lavender recover`: writes what is whole of damaged logs beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

WHOLE, PART, NOTHING = 0, 3, 5  # exit codes; of several logs the largest


def recover(
    logs: Annotated[
        list[Path],
        typer.Argument(metavar="LOG_OR_RUN...", help="Logs (.mcap), or directories of runs."),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            *("--output", "-o"),
            metavar="FILE.mcap",
            help="Of one log: where it is recovered to; never an existing file.",
        ),
    ] = None,
) -> None:
    """Write what is whole of damaged logs to LOG.recovered.mcap beside each.

    No file that exists is written to. Exits 0 when every log is whole or was
    recovered with nothing lost, 3 when a part of one is lost, and 5 when
    nothing of one could be recovered.
    """
    from lavendersim.errors import TraceError, UsageError
    from lavendersim.trace import recover
    from lavendersim.trace.recovery import beside, needs_recovery

    chosen = _chosen(logs)
    if output is not None and len(chosen) > 1:
        raise UsageError(f"--output is for one log, and these are {len(chosen)}")
    # Before anything is written: a run half recovered would be refused when it is tried again.
    for log in chosen:
        out = output or beside(log)
        if out.exists() and needs_recovery(log):
            raise UsageError(f"{out}: exists already, and recover writes to no file that does")
    code = WHOLE
    for log in chosen:
        try:
            report = recover(log, output)
        except TraceError as error:
            typer.echo(str(error), err=True)
            code = max(code, NOTHING)
            continue
        what = f"{report.steps} steps up to t = {report.last_time:g} s"
        if report.out is None:
            typer.echo(f"{log}: left as it is, {report.outcome}: {what}")
        else:
            typer.echo(f"{report.out}: {report.outcome}: {what}")
        for lost in report.lost:
            typer.echo(f"{log}: lost: {lost}", err=True)
        code = max(code, WHOLE if report.outcome == "whole" else PART)
    if code != WHOLE:
        raise typer.Exit(code)


def _chosen(named: list[Path]) -> list[Path]:
    """Return the logs that are named, those of runs among them. UsageError where there is none."""
    from lavendersim.errors import UsageError
    from lavendersim.runner.run_directory import Run, is_run_directory

    chosen: list[Path] = []
    for path in named:
        if is_run_directory(path):
            chosen += Run(path).logs()
        elif path.is_file():
            chosen.append(path)
        else:
            what = "not the directory of a run" if path.is_dir() else "no such log"
            raise UsageError(f"{path}: {what}")
    return list(dict.fromkeys(chosen))
