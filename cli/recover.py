"""`lavender recover`: a log that was cut off in, a whole one with what could be read out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def recover(
    log: Annotated[Path, typer.Argument(help="Log of a killed run (.mcap).")],
    out: Annotated[Path, typer.Argument(help="Where the salvaged log is written.")],
) -> None:
    """Save what a killed run left in its log. Exits 3: the log was salvaged, not complete."""
    from lavendersim.trace import recover

    typer.echo(recover(log, out))
    raise typer.Exit(3)
