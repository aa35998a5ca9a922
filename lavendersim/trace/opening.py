"""Opens logs: a whole one, or what is whole of a damaged one."""

from __future__ import annotations

from pathlib import Path

from lavendersim.cell import CellConfig
from lavendersim.errors import TraceError
from lavendersim.trace.index import damage, read_summary
from lavendersim.trace.reader import Trace
from lavendersim.trace.scan import scan
from lavendersim.trace.source import LogFile, PartOfLog
from lavendersim.trace.whole import ExpectedLog


def open_trace(
    path: str | Path,
    allow_incomplete: bool = False,
    config: CellConfig | None = None,
    expected: ExpectedLog | None = None,
) -> Trace:
    """Return the log at `path`, its columns not yet read.

    config: that of its cell, where the caller has it already; it is not read from the log then.
    expected: what the index of its run says of it.

    TraceError when the file is missing, damaged, unfinished, what was recovered of one or not the
    expected one, at once or with its first column. With `allow_incomplete` its whole groups of
    steps are read, its status is `incomplete`, and `damage` says why.
    """
    path = Path(path)
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    try:
        entries = read_summary(path, expected.digest if expected else None)
        trace = Trace(path, LogFile(path, entries, expected), config=config)
        if allow_incomplete:
            trace.verify()
    except TraceError as error:
        recovered = _recovered(path, config, expected)
        if recovered is None:
            if not allow_incomplete:
                raise
            return _part(path, config, expected, str(error))
        trace = recovered
    if trace.damage and not allow_incomplete:
        raise TraceError(f"{trace.damage}; it is no whole log (allow_incomplete)")
    return trace


def _recovered(path: Path, config: CellConfig | None, expected: ExpectedLog | None) -> Trace | None:
    """Return what was recovered of the log that is expected; None where something else is there."""
    if expected is None:
        return None
    try:
        source = LogFile(path, read_summary(path), ExpectedLog(expected.config))
        trace = Trace(path, source, config=config)
        if trace.damage:
            trace.verify()
    except TraceError:
        return None
    return trace if trace.damage else None


def _part(path: Path, config: CellConfig | None, expected: ExpectedLog | None, why: str) -> Trace:
    """Return what is whole of a damaged log. TraceError where nothing is, or of another cell."""
    with damage(path, "the log"):
        part = PartOfLog(path, scan(path).entries, expected)
        part.check_config()
        return Trace(path, part, why, config)
