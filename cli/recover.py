"""`lavender recover`: salvages a log that was cut off into one that can be read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def recover(
    log: Annotated[Path, typer.Argument(help="Log of a killed run (.mcap).")],
    out: Annotated[Path, typer.Argument(help="Where the salvaged log is written.")],
) -> None:
    """Save what a killed run left in its log. Exits 3: the log was salvaged, not complete."""
    from lavendersim.errors import UsageError
    from lavendersim.trace import recover

    if not log.is_file():  # not a log that is damaged
        raise UsageError(f"{log}: no such log")
    report = recover(log, out)
    typer.echo(
        f"{report.out}: {report.steps} steps up to t = {report.last_time:g} s; "
        f"{report.saved} bytes saved, {report.lost} lost"
    )
    raise typer.Exit(3)
