"""Folders that benchmarks run in, all deleted when the process ends.

Not one after the other: ext4 leaves the places of files that were just deleted alone for seconds,
and looks through them for each new file: up to 0.6 ms of it, behind the lock of the folder.
"""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path


@cache
def _all() -> str:
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder)
    return folder


def new_folder() -> Path:
    """Return an empty folder."""
    return Path(tempfile.mkdtemp(dir=_all()))
