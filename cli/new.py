"""`lavender new`: writes a commented config to begin with, for a question picked from a list."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from lavender_cli.asking import answered
from lavender_cli.completion import start_names


def new(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="[NAME]", help="Of the list; without it, the list.", autocompletion=start_names
        ),
    ] = None,
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="A new file; NAME.yaml by default.")
    ] = None,
) -> None:
    """Write a commented config for a question; without a name, list the questions."""
    from lavendersim.runner.starting_configs import start_named, starts, write_start

    if name is None:
        known = starts()
        width = max(len(start.name) for start in known)
        for number, start in enumerate(known, 1):
            typer.echo(f"{number:2}  {start.name:{width}}  {start.question}")
        if not (sys.stdin.isatty() and sys.stdout.isatty()):
            typer.echo("write one with: lavender new NAME [FILE]", err=True)
            return
        picked = answered("Which? (number or name)")
        is_number = picked.isdecimal() and 1 <= int(picked) <= len(known)
        name = known[int(picked) - 1].name if is_number else picked
    start = start_named(name)
    path = file if file is not None else Path(f"{start.name}.yaml")
    write_start(start, path)
    typer.echo(f"{path}: {start.question}")
    typer.echo(f"  run it with: lavender run {shlex.quote(str(path))} --plot")
