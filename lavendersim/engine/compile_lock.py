"""One process at a time compiles a kernel: who wants it meanwhile waits, and loads what was made.

Record locks (POSIX) of single bytes of one file, a byte for each kernel: the system ends them with
their process, they are not inherited, and one file is all that stays. Waiting has an end: a process
that is stopped holds its lock for as long. Where a system has no such locks, nobody waits.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Final

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

NAME: Final = "compiling.lock"
LONGEST_WAIT: Final = 120.0  # [s]; the largest plans take 25 s of a processor that is not shared
_PAUSE: Final = 0.05  # [s] between two looks
_DIGITS: Final = 7  # hex, of a key: 2^28 bytes that can be locked. Kernels of one byte wait in turn


class CompileLock:
    """The lock that one process holds while it compiles a kernel."""

    def __init__(self) -> None:
        self._handle: int | None = None

    def take(self, folder: Path, key: str, longest: float = LONGEST_WAIT) -> bool:
        """Wait for the lock of a kernel, `longest` [s] at most; returns whether it has come.

        folder: where kernels are kept. key: hex name of the kernel's code.
        """
        self.release()
        if fcntl is None:
            return False
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
            handle = os.open(folder / NAME, flags, 0o600)
        except OSError:  # a full or read-only disk costs time, not the run
            return False
        try:
            free = _taken(handle, int(key[:_DIGITS], 16), time.monotonic() + longest)
        except OSError:  # a disk without locks
            free = False
        except BaseException:
            os.close(handle)
            raise
        if free:
            self._handle = handle
        else:
            os.close(handle)
        return free

    def release(self) -> None:
        """Let another process have the lock."""
        if self._handle is not None:
            os.close(self._handle)
            self._handle = None


def _taken(handle: int, place: int, end: float) -> bool:
    """Lock one byte of a file; returns whether that was so before `end` of the monotonic clock."""
    while True:
        try:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)
        except (BlockingIOError, PermissionError):  # EAGAIN or EACCES: another process has it
            if time.monotonic() > end:
                return False
            time.sleep(_PAUSE)
        else:
            return True
