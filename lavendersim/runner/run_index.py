"""Rows of the index of a run, `cells.json`: which log is whose, by digests; how cells ended.

While cells run, the index has them as pending, and a line is appended to `ended.jsonl` for each
that ends: to write all of the index every time would take, of a sweep, the square of its cells. Who
reads the index reads both. The line is one write by the process that ran the cell, so it is whole
after a kill or is not counted. It is not flushed to the disk: after a power loss it may speak of a
log that is cut, which its digest shows.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lavendersim.errors import TraceError

if TYPE_CHECKING:
    from lavendersim.trace import ExpectedLog, LogDigest

PENDING: Final = "pending"
ENDED: Final = "ended.jsonl"


def as_row(digest: LogDigest | None) -> dict[str, Any] | None:
    """Return what the index says of a log that was closed."""
    if digest is None:
        return None
    return {"bytes": digest.size, "crc32": f"{digest.crc:08x}", "sha256": digest.sha256}


def expected_of(row: Mapping[str, Any]) -> ExpectedLog:
    """Return what a row of the index says of its log; nothing where an older version wrote it."""
    from lavendersim.trace import ExpectedLog, LogDigest  # late, as is all of the trace

    log = row.get("log")
    digest = LogDigest(log["bytes"], int(log["crc32"], 16), log["sha256"]) if log else None
    return ExpectedLog(row.get("config", ""), digest)


def note_ended(log: Path, status: str, digest: LogDigest) -> None:
    """Append how the cell of a log ended, when the log is closed."""
    line = json.dumps({"file": log.name, "status": status, "log": as_row(digest)}) + "\n"
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT
    handle = os.open(log.parent.parent / ENDED, flags, 0o666)
    try:
        os.write(handle, line.encode())
    finally:
        os.close(handle)


def add_ended(rows: Sequence[dict[str, Any]], directory: Path) -> None:
    """Enter how cells of a run that goes on, or was killed, have ended so far."""
    path = directory / ENDED
    try:
        lines = path.read_bytes().split(b"\n")[:-1]  # what follows the last end of a line is cut
    except FileNotFoundError:
        return
    try:
        ended = {one["file"]: one for one in map(json.loads, lines)}
        for row in rows:
            if (one := ended.get(Path(row["file"]).name)) is not None:
                row |= {"status": one["status"], "log": one["log"]}
    except (ValueError, KeyError, TypeError) as error:
        raise TraceError(f"{path}: damaged: {error}") from None
