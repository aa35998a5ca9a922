"""Opens logs: a whole one, or what is whole of a damaged one."""

from __future__ import annotations

from pathlib import Path

from lavendersim.cell import CellConfig
from lavendersim.errors import TraceError
from lavendersim.trace.index import damage, read_summary
from lavendersim.trace.reader import Trace
from lavendersim.trace.scan import scan
from lavendersim.trace.source import LogFile, PartOfLog


def open_trace(
    path: str | Path, allow_incomplete: bool = False, config: CellConfig | None = None
) -> Trace:
    """Return the log at `path`, its columns not yet read.

    config: that of its cell, where the caller has it already; it is not read from the log then.

    TraceError when the file is missing, damaged, unfinished or what was recovered of one, at once
    or with its first column. With `allow_incomplete` its whole groups of steps are read, its status
    is `incomplete`, and `damage` says why.
    """
    path = Path(path)
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    try:
        trace = Trace(path, LogFile(path, read_summary(path)), config=config)
        if allow_incomplete:
            trace.verify()
    except TraceError as error:
        if not allow_incomplete:
            raise
        why = str(error)
    else:
        if trace.damage and not allow_incomplete:
            raise TraceError(f"{trace.damage}; it is no whole log (allow_incomplete)")
        return trace
    with damage(path, "the log"):
        return Trace(path, PartOfLog(path, scan(path).entries), why, config)
