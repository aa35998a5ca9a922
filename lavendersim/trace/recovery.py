"""Makes a well-formed log, marked as recovered, of the whole part of a killed or damaged one."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace.container import Container
from lavendersim.trace.index import damage
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.scan import Prefix, scan
from lavendersim.trace.whole import check_bytes
from lavendersim.trace.writer import ENDING


class RecoveryReport(NamedTuple):
    """What was saved of a log."""

    path: Path
    out: Path
    steps: int  # rows of /step saved
    last_time: float  # of the last of them [s]
    saved: int  # bytes of the old file that stand in the new one
    lost: int  # bytes behind them
    status: str  # of the new log


def recover(path: str | Path, out: str | Path) -> RecoveryReport:
    """Write the whole part of a killed or damaged log to `out`, which may be `path` itself.

    UsageError when the log is whole already; TraceError when nothing of it can be saved.
    """
    path, out = Path(path), Path(out)
    if not path.is_file():
        raise TraceError(f"{path}: no such log")
    if _is_whole(path):
        raise UsageError(f"{path}: nothing to recover, this log is whole")
    with damage(path, "the log"):
        prefix = scan(path)
        steps = prefix.entries.counts[CHANNELS["/step"]]
        last_ns = prefix.entries.statistics().message_end_time
    status = f"recovered: {steps} steps, up to {last_ns / 1e9:.9g} s; {prefix.reason}"
    _write(prefix, status, out)
    return RecoveryReport(path, out, steps, last_ns / 1e9, len(prefix.data), prefix.lost, status)


def _is_whole(path: Path) -> bool:
    try:
        check_bytes(path)
    except TraceError:
        return False
    return True


def _write(prefix: Prefix, status: str, out: Path) -> None:
    """Write beside `out` first: a second kill must not cost what the first one left."""
    beside = out.with_name(out.name + ".recovering")
    container = Container.resume(beside, prefix.data, prefix.entries)
    container.describe(ENDING, {"status": status})
    container.finish()
    os.replace(beside, out)
