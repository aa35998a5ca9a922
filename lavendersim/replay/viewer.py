"""An open rerun window, at a moment where one is requested.

A blueprint cannot say where the time cursor stands (rerun 0.41: TimePanel has no such field), so
the time is sent to the viewer's port once it has the recording.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import rerun as rr
from rerun.experimental import ViewerClient

from lavendersim.errors import LavenderError
from lavendersim.replay.drivers import require_display, viewer_program
from lavendersim.replay.recording import moment_to_show, new_stream, record
from lavendersim.replay.timeline import TIMELINE
from lavendersim.replay.viewpoint import DEFAULT_VIEW, Viewpoint

if TYPE_CHECKING:
    import numpy as np

    from lavendersim.replay.pair import LogPair
    from lavendersim.trace import Trace

LOADED_SECONDS = 30.0  # a viewer that is not open yet starts in 1-5 s, and then takes the recording
POLL_SECONDS = 0.1
VIEWER = "rerun+http://127.0.0.1:9876/proxy"  # where rr.spawn opens one, or finds an open one


def show_in_window(
    trace: Trace | LogPair,
    title: str,
    at: float | None = None,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> None:
    """Open the viewer (or use the open one), send it the trace, and stop it at a moment [s]."""
    moment = None if at is None else moment_to_show(trace, at)
    stream = new_stream(title)
    open_window(stream)
    record(trace, stream, title, viewpoint)
    stream.flush(timeout_sec=60.0)
    if moment is not None:
        stop_at(moment, str(stream.get_recording_id()))
    stream.disconnect()


def open_window(stream: rr.RecordingStream) -> None:
    """Open the viewer, or use the open one, for a stream."""
    require_display()
    rr.spawn(executable_path=str(viewer_program()), recording=stream)


def stop_at(moment: np.timedelta64, recording: str, url: str = VIEWER) -> None:
    """Put the time cursor of an open viewer to a moment, as soon as it has all of a recording."""
    deadline = time.monotonic() + LOADED_SECONDS
    client: ViewerClient | None = None
    while time.monotonic() < deadline:
        try:
            client = client or ViewerClient.connect(url)
            if (store := _loaded(client, recording, moment)) is not None:
                client.set_time(TIMELINE, duration=moment, play_state="paused", recording=store)
                return
        except (ConnectionError, RuntimeError):
            client = None  # not listening yet
        time.sleep(POLL_SECONDS)
    raise LavenderError(f"rerun's viewer did not take the recording within {LOADED_SECONDS:.0f} s")


def _loaded(client: ViewerClient, recording: str, moment: np.timedelta64) -> str | None:
    """Return the viewer's name of a recording once what it has of it reaches the moment."""
    for one in client.get_state().recordings:
        lines = [line for line in one.timelines if line.name == TIMELINE and line.end is not None]
        if recording in one.store_id and lines:
            return one.store_id if int(lines[0].end or 0) >= int(moment.astype("int64")) else None
    return None
