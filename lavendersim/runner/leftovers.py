"""What killed processes left half written in a folder of runs.

Files are written aside and renamed (`durable_files`), so what is left under a name of its own is
nothing that anybody reads. A run whose directory is locked (`run_lock`) is left alone.

    remove_leftovers   before a run, in runs that did not finish and that nobody goes on with
    clean              all that is left, on request (`lavender doctor --clean`)
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Final, NamedTuple

from lavendersim.errors import UsageError

from .run_directory import LATEST, is_run_directory, is_running
from .run_lock import run_lock
from .run_seal import DONE

# How the directory of a run is called (`make_directory`): of one killed before its index is written
# this alone says what it is.
RUN_NAME: Final = re.compile(r"\d{8}T\d{6}Z[.-]")
UNFINISHED: Final = ".*.unfinished*"  # names of files that are written aside
REMOVED: Final = ".removed-"  # begins the name of a run that is being removed
# Also what `recover` wrote aside up to version 0.1, and the signs of folders that workers share.
HALF_WRITTEN: Final = (UNFINISHED, "*.recovering", ".*.sign")
# Whose name says which process writes it: `.STEM.PID-NUMBER.unfinished`, `.latest-PID`.
WRITER: Final = re.compile(r"\.(\d+)-\d+\.unfinished|^\.latest-(\d+)$|^\.removed-(\d+)-")


class Left(NamedTuple):
    """What was removed: how many files, and their size [byte]."""

    files: int
    size: int

    def __str__(self) -> str:
        return f"{self.files} file{'' if self.files == 1 else 's'}, {self.size / 1e6:.1f} MB"


def remove_leftovers(root: Path) -> None:
    """Remove what is half written in the runs below a folder that did not finish."""
    for directory in _runs(root):
        if (directory / DONE).exists():
            continue
        # A directory is locked for no longer than it takes, and not at all where nothing is left.
        if not [*directory.rglob(UNFINISHED)]:
            continue
        with suppress(UsageError, OSError), run_lock(directory):
            for left in directory.rglob(UNFINISHED):
                left.unlink(missing_ok=True)


def clean(root: Path) -> Left:
    """Remove all that killed processes left in a folder of runs, finished ones too.

    Not what a process of this machine still writes, nor anything in a run that one goes on with.
    """
    sizes = [_unlinked(left) for left in _beside_runs(root) if not _is_written(left)]
    for left in root.glob(f"{REMOVED}*"):
        if not _is_written(left):
            sizes += [_size(file) for file in left.rglob("*") if not file.is_dir()]
            shutil.rmtree(left, ignore_errors=True)
    for directory in _runs(root):
        if not _left_in(directory):
            continue
        with suppress(UsageError, OSError), run_lock(directory):
            sizes += [_unlinked(left) for left in _left_in(directory)]
    removed = [size for size in sizes if size is not None]
    return Left(len(removed), sum(removed))


def _runs(root: Path) -> Iterator[Path]:
    """Yield the directories of runs below a folder."""
    for directory in root.glob("[!.]*"):
        if directory.is_symlink() or not directory.is_dir():
            continue
        if is_run_directory(directory) or RUN_NAME.match(directory.name):
            yield directory


def _beside_runs(root: Path) -> list[Path]:
    """Return what is half written of the link to the newest run."""
    return [*root.glob(f".{LATEST}-*"), *root.glob(f".{LATEST}.*.unfinished*")]


def _left_in(directory: Path) -> list[Path]:
    """Return what is half written in a run, and of a finished one by nobody who lives.

    Verbs that draw and export take no lock of a run: of theirs the names of files tell.
    """
    found = [path for pattern in HALF_WRITTEN for path in directory.rglob(pattern)]
    if (directory / DONE).exists():
        return [path for path in found if not _is_written(path)]
    return found


def _is_written(path: Path) -> bool:
    """Whether its name says that a process of this machine writes it."""
    found = WRITER.search(path.name)
    return found is not None and is_running(next(filter(None, found.groups())))


def _unlinked(path: Path) -> int | None:
    """Remove a file; returns its size, or None where it cannot be removed or is gone."""
    size = _size(path)
    with suppress(OSError):
        path.unlink()
        return size
    return None


def _size(path: Path) -> int:
    with suppress(OSError):
        return path.lstat().st_size
    return 0
