"""The log of a run as an MCAP file: its writer, its reader and its recovery.

What stands in the file: `schema`. Written by `TraceWriter`, read by `open_trace`, and `recover`
makes a readable file of what a killed run left.
"""

from lavendersim.trace.blocks import Block
from lavendersim.trace.reader import Trace, open_trace
from lavendersim.trace.recover import RecoveryReport, recover
from lavendersim.trace.writer import TraceWriter, Written
from lavendersim.trace.written_trace import trace_of

__all__ = [
    "Block",
    "RecoveryReport",
    "Trace",
    "TraceWriter",
    "Written",
    "open_trace",
    "recover",
    "trace_of",
]
