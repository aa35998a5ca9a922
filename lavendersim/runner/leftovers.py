"""What killed processes left half written in runs that nobody goes on with: removed before a run.

Files are written aside and renamed (`durable_files`), so what is left under a name of its own is
nothing that anybody reads. A run whose directory is locked (`run_lock`) is left alone.
"""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from typing import Final

from lavendersim.errors import UsageError

from .run_directory import is_run_directory
from .run_lock import run_lock
from .run_seal import DONE

# How the directory of a run is called (`make_directory`): of one killed before its index is written
# this alone says what it is.
RUN_NAME: Final = re.compile(r"\d{8}T\d{6}Z[.-]")
UNFINISHED: Final = ".*.unfinished*"  # names of files that are written aside


def remove_leftovers(root: Path) -> None:
    """Remove what is half written in the runs below a folder that did not finish."""
    for directory in root.glob("[!.]*"):
        if directory.is_symlink() or (directory / DONE).exists():
            continue
        if not (is_run_directory(directory) or RUN_NAME.match(directory.name)):
            continue
        # A directory is locked for no longer than it takes, and not at all where nothing is left.
        if not [*directory.rglob(UNFINISHED)]:
            continue
        with suppress(UsageError, OSError), run_lock(directory):
            for left in directory.rglob(UNFINISHED):
                left.unlink(missing_ok=True)
