"""The command that goes on with what a signal or a full disk ended, printed where that happens."""

from __future__ import annotations

import errno
import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

# A disk or a quota is full, a file as large as may be, or the disk fails.
DISK = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


@contextmanager
def interruptible(command: str) -> Iterator[None]:
    """Print the command that goes on with what is run where a signal ends that."""
    from lavendersim.runner.interruption import handled

    try:
        with handled():  # what a library makes of a signal is that signal
            yield
    except KeyboardInterrupt as end:  # it says by what, and where what was simulated is
        if str(end):
            typer.echo(str(end), err=True)
        typer.echo(f"go on with: {command}", err=True)
        raise


@contextmanager
def on_full_disk(command: str) -> Iterator[None]:
    """Print the command that goes on with what is run where the disk ends that."""
    try:
        yield
    except OSError as error:
        if error.errno in DISK:
            typer.echo(f"go on with: {command}", err=True)
        raise


def as_words(options: Mapping[str, Any]) -> list[str]:
    """Return options as they stand on a command line; those without a value are left out."""
    words: list[str] = []
    for option, value in options.items():
        if value is True:
            words.append(option)
        elif value:
            each = value if isinstance(value, list) else [value]
            words += [word for one in each for word in (option, str(one))]
    return words


def command_of(verb: str, configs: list[Path], overrides: list[str], *options: str) -> str:
    """Return the command that runs the same with options of its own, as a shell takes it."""
    changed = [part for one in overrides for part in f"--{one}".split(" ", 1)]
    return shlex.join(["lavender", verb, *map(str, configs), *changed, *options])
