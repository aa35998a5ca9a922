"""The log of a run as an MCAP file: its writer, its reader and its recovery.

What stands in the file: `schema`. Written by `TraceWriter`, read by `open_trace`, and `recover`
makes a readable file of what is whole of a damaged one. Names are imported when they are used: to
see that a log was closed needs no numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lavendersim.trace.blocks import Block
    from lavendersim.trace.opening import open_trace
    from lavendersim.trace.reader import Trace
    from lavendersim.trace.recovery import RecoveryReport, recover
    from lavendersim.trace.whole import ExpectedLog, LogDigest, check_closed, digest_of_closed
    from lavendersim.trace.writer import TraceWriter, Written
    from lavendersim.trace.written_trace import trace_of

_HOME = {
    "Block": "blocks",
    "ExpectedLog": "whole",
    "LogDigest": "whole",
    "RecoveryReport": "recovery",
    "Trace": "reader",
    "TraceWriter": "writer",
    "Written": "writer",
    "check_closed": "whole",
    "digest_of_closed": "whole",
    "open_trace": "opening",
    "recover": "recovery",
    "trace_of": "written_trace",
}

__all__ = [
    "Block",
    "ExpectedLog",
    "LogDigest",
    "RecoveryReport",
    "Trace",
    "TraceWriter",
    "Written",
    "check_closed",
    "digest_of_closed",
    "open_trace",
    "recover",
    "trace_of",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name in _HOME:
        return getattr(import_module(f"lavendersim.trace.{_HOME[name]}"), name)
    raise AttributeError(f"module 'lavendersim.trace' has no attribute {name!r}")
