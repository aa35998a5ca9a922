"""A trace enters; an open rerun window leaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rerun as rr

from lavendersim.replay.drivers import require_display, viewer_program
from lavendersim.replay.recording import new_stream, record

if TYPE_CHECKING:
    from lavendersim.trace import Trace


def show_in_window(trace: Trace, title: str) -> None:
    """Open the viewer (or use the open one) and send it the trace."""
    require_display()
    stream = new_stream(title)
    rr.spawn(executable_path=str(viewer_program()), recording=stream)
    record(trace, stream, title)
    stream.flush(timeout_sec=60.0)
    stream.disconnect()
