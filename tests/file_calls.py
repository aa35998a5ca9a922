"""What the door of files asks of the system, kept in order; any call of it can be made to fail."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from threading import Lock
from typing import Any, NamedTuple

import pytest

from lavendersim import durable_files

CALLS = ("open", "write", "fsync", "replace", "link")


class Call(NamedTuple):
    """One call, and the file or folder that it is of; of a rename the new name."""

    name: str
    path: Path


class FileCalls:
    """The calls so far. fails: the number of the one that fails, from 0; none where it is None."""

    def __init__(self, fails: int | None = None, error: int = errno.ENOSPC) -> None:
        self.made: list[Call] = []
        self.fails, self.error = fails, error
        self.source: dict[Path, Path] = {}  # of each rename
        self._handles: dict[int, Path] = {}
        self._lock = Lock()  # several threads flush

    def watch(self, patch: pytest.MonkeyPatch) -> FileCalls:
        """Stand between the door and the system."""
        system = type("Calls", (), dict(vars(os)))
        for name in CALLS:
            setattr(system, name, staticmethod(self._watched(name, getattr(os, name))))
        patch.setattr(durable_files, "os", system)
        real = durable_files.flush_file_system
        patch.setattr(
            durable_files,
            "flush_file_system",
            lambda path: self._note("syncfs", path) or real(path),
        )
        return self

    def _watched(self, name: str, real: Any) -> Any:
        def call(first: Any, *rest: Any, **named: Any) -> Any:
            path = self._handles.get(first) if isinstance(first, int) else Path(first)
            if name in ("replace", "link"):
                self.source[Path(rest[0])] = Path(first)
                path = Path(rest[0])
            assert path is not None
            self._note(name, path)
            result = real(first, *rest, **named)
            if name == "open":
                self._handles[result] = path
            return result

        return call

    def _note(self, name: str, path: Path) -> None:
        with self._lock:
            self.made.append(Call(name, path))
            fails = self.fails == len(self.made) - 1
        if fails:
            raise OSError(self.error, os.strerror(self.error), str(path))

    def at(self, name: str, path: Path) -> int:
        """Return where the last such call of a file is among all."""
        return max(i for i, call in enumerate(self.made) if call == (name, path))
