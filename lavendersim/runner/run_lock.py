"""One process at a time runs cells in the directory of a run; the system ends its hold with it.

A lock of the directory itself leaves no file behind, and none that a kill would leave locked. Where
a system has no such lock, nobody is kept out.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from lavendersim.errors import UsageError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]


@contextmanager
def run_lock(directory: Path) -> Iterator[None]:
    """Keep other processes from running cells in a directory. UsageError where one does."""
    if fcntl is None:
        yield
        return
    handle = os.open(directory, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(f"{directory}: another process runs its cells") from None
        yield
    finally:
        os.close(handle)
