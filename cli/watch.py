"""`--watch`: a command is done again whenever one of its files is saved, until Ctrl-C."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import typer


def again(configs: list[Path], once: Callable[[], None]) -> None:
    """Do it once, and again after every save; what is wrong with a config is printed meanwhile."""
    from lavendersim.errors import LavenderError
    from lavendersim.runner.watched_files import saves

    for files in saves(configs):
        try:
            once()
        except typer.Exit:
            pass  # what failed is printed
        except LavenderError as error:
            typer.echo(str(error), err=True)
        typer.echo(f"watching {files} file{'s' * (files != 1)}; Ctrl-C ends it", err=True)
