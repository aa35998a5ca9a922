"""Runs removed from a folder: those that are named, or all that are meant but the newest of each.

A run that another process works in stays. A directory is renamed before it is emptied, so that what
a kill leaves is no run.
"""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

from lavendersim.errors import TraceError, UsageError

from .leftovers import REMOVED
from .listing import Listed, listed_run
from .run_directory import LATEST, Run, list_runs, point_latest
from .run_lock import run_lock


def removable(meant: Sequence[Listed], root: Path) -> list[Listed]:
    """Return which of the runs that are meant may go: the newest finished one of each stays.

    Of each experiment with the same options, that is; one that did not finish is no newest.
    """
    newest = {_kind(run): run.path for run in list_runs(root) if run.finished}
    kept = {path.resolve() for path in newest.values()}
    return [one for one in meant if one.run.path.resolve() not in kept]


def named_run(path: Path, root: Path) -> Listed:
    """Return a run by its directory or name. UsageError where there is none."""
    from .run_directory import open_run

    found = open_run(path, root)
    if found.path.is_symlink():  # `latest` names a run, and is none
        found = Run(found.path.resolve())
    return listed_run(found)


def remove(runs: Iterable[Run], root: Path) -> int:
    """Remove runs, and make `latest` name the newest that is left; returns how many.

    UsageError where another process works in one: those before it are gone.
    """
    count = 0
    try:
        for run in runs:
            with run_lock(run.path):
                aside = run.path.with_name(f"{REMOVED}{os.getpid()}-{run.path.name}")
                os.rename(run.path, aside)
            shutil.rmtree(aside)
            count += 1
    finally:
        _repoint_latest(root)
    return count


def remove_leftovers(root: Path) -> None:
    """Remove what earlier removals left that were killed."""
    for left in root.glob(f"{REMOVED}*"):
        shutil.rmtree(left, ignore_errors=True)


def _repoint_latest(root: Path) -> None:
    """Make `latest` name a run that there is."""
    latest = root / LATEST
    if latest.is_symlink():
        if latest.exists():
            return
    elif not latest.is_file() or (root / latest.read_text().strip()).exists():
        return
    finished = [run for run in list_runs(root) if run.finished]
    if finished:
        point_latest(finished[-1].path, root)
    else:
        with contextlib.suppress(FileNotFoundError):
            latest.unlink()


def _kind(run: Run) -> tuple[object, ...]:
    """Return what runs of the same question have in common."""
    try:
        return (run.name, *run.options)
    except (TraceError, UsageError, KeyError):  # a damaged one is the newest of nothing
        return (run.path,)
