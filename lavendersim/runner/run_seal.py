"""The seal of a finished run: `DONE` has the SHA-256 of each of its tables.

    DONE -> cells.json -> every log
         -> results.json, config.yaml, ...

It is written last, in the form of `sha256sum`: `sha256sum -c DONE` checks them, too. What is made
of a finished run later (figures, finer timesteps) is not under it. That of older runs is empty.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from lavendersim.errors import TraceError

DONE: Final = "DONE"
_LINE: Final = re.compile(r"([0-9a-f]{64})  ([\w.]+)")


def seal_of(directory: Path, names: Iterable[str]) -> str:
    """Return the seal of a run's files, those that there are."""
    return "".join(
        f"{_digest_of(directory / name)}  {name}\n" for name in names if (directory / name).exists()
    )


def _digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, read in pieces: tables of many cells are large."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sealed(directory: Path) -> dict[str, str]:
    """Return the digests of the tables of a run; none while it is not finished, or is older.

    TraceError where the seal is damaged.
    """
    try:
        lines = (directory / DONE).read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        return {}
    found = [_LINE.fullmatch(line) for line in lines]
    if not all(found):
        raise TraceError(f"{directory / DONE}: damaged: a line of it has no digest")
    return {one[2]: one[1] for one in found if one}


def read_sealed(path: Path) -> bytes:
    """Return a table of a run. TraceError where it is missing, or not as it was written."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise TraceError(f"{path}: missing, the run wrote it") from None
    digests = sealed(path.parent)
    if digests and hashlib.sha256(data).hexdigest() != digests.get(path.name):
        raise TraceError(f"{path}: changed since the run wrote it: {DONE} has another digest")
    return data
