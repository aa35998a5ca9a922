"""How cells of a run ended, one line a cell, `ended.jsonl`; digests of logs as JSON has them.

While cells run, the index (`cells_index`) has them as pending, and two lines are appended here for
each that ends, when its log is closed and when that is measured (`cell_outcome`): to write all of
the index every time would take, of a sweep, the square of its cells. Who reads the index reads
both. A line is one write by the process that ran the cell, so it is whole after a kill or is not
counted. It is not flushed to the disk: after a power loss it may speak of a log that is cut, which
its digest shows.
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from lavendersim.trace import LogDigest

PENDING: Final = "pending"
ENDED: Final = "ended.jsonl"


def as_row(digest: LogDigest | None) -> dict[str, Any] | None:
    """Return what the index says of a log that was closed."""
    if digest is None:
        return None
    return {"bytes": digest.size, "crc32": f"{digest.crc:08x}", "sha256": digest.sha256}


def digest_of(row: Mapping[str, Any] | None) -> LogDigest | None:
    """Return the digest of a log from what the index says of it."""
    from lavendersim.trace import LogDigest  # late, as is all of the trace

    return LogDigest(row["bytes"], int(row["crc32"], 16), row["sha256"]) if row else None


def note_ended(log: Path, status: str, digest: LogDigest | None, **more: Any) -> None:
    """Append how the cell of a log ended, and more that is known of it."""
    row = {"file": log.name, "status": status, "log": as_row(digest), **more}
    append_line(log.parent.parent / ENDED, row)


def append_line(path: Path, row: Mapping[str, Any]) -> None:
    """Append a row in one write, so that it is whole or cut by its end after a kill."""
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT
    handle = os.open(path, flags, 0o666)
    try:
        os.write(handle, (json.dumps(row) + "\n").encode())
    finally:
        os.close(handle)


def ended_rows(directory: Path) -> dict[str, dict[str, Any]]:
    """Return the last row about each log that was closed, by its name; the last line may be cut.

    ValueError, KeyError or TypeError where the file is damaged.
    """
    try:
        lines = (directory / ENDED).read_bytes().split(b"\n")[:-1]  # what follows is cut
    except FileNotFoundError:
        return {}
    return {one["file"]: one for one in map(json.loads, lines)}


def logs_closed(directory: Path) -> set[str]:
    """Return the names of the logs of cells that ended by themselves, measured or not."""
    from lavendersim.trace.whole import INTERRUPTED  # late, as is all of the trace

    rows = ended_rows(directory)
    return {name for name, row in rows.items() if not row["status"].startswith(INTERRUPTED)}


def drop_cut_line(directory: Path) -> None:
    """Remove the end of a line that a kill has cut: none may stand behind it."""
    try:
        with (directory / ENDED).open("r+b") as file:
            file.truncate(file.read().rfind(b"\n") + 1)
    except FileNotFoundError:
        pass


def kept_lines(directory: Path, names: Collection[str]) -> str:
    """Return the lines about the logs of these names, each whole."""
    rows = ended_rows(directory)
    return "".join(json.dumps(row) + "\n" for name, row in rows.items() if name in names)
