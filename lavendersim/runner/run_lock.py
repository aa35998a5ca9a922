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

_locked: set[int] = set()  # handles of the directories that this process has locked


@contextmanager
def run_lock(directory: Path) -> Iterator[None]:
    """Keep other processes from running cells in a directory. UsageError where one does."""
    if fcntl is None:
        yield
        return
    handle = os.open(directory, os.O_RDONLY)
    _locked.add(handle)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(f"{directory}: another process runs its cells") from None
        yield
    finally:
        _locked.remove(handle)
        os.close(handle)


def is_locked(directory: Path) -> bool:
    """Whether a process, this one or another, runs cells in a directory."""
    if fcntl is None:
        return True
    handle = os.open(directory, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(handle)
    return False


def _begin_forked() -> None:
    """Let the lock end with the process that took it, whatever was forked of it."""
    while _locked:
        os.close(_locked.pop())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_forked)
