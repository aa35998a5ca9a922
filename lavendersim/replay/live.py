"""A log that is still written, shown as it grows.

It is read again and again: what is whole of it by then is sent, from where it was read to before.
The run knows nothing of it. Where bodies leave the room that is drawn, or forces the scale of their
arrows, all of it is sent once more, as it would be of the finished log.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Final, NamedTuple

import rerun as rr

from lavendersim.durable_files import written_aside
from lavendersim.errors import TraceError
from lavendersim.replay import columns, scene
from lavendersim.replay.force_scale import ForceScale
from lavendersim.replay.recording import measures_of, new_stream, record
from lavendersim.replay.viewer import open_window
from lavendersim.replay.viewpoint import DEFAULT_VIEW, Viewpoint

if TYPE_CHECKING:
    from lavendersim.trace import Trace

PAUSE: Final = 0.5  # [s] between two looks at a log
SHARE: Final = 4.0  # and so many times what the last one took: a long log is read less often
GROWTH: Final = 1.5  # of a room or of a scale, beyond which all is drawn anew


class GrowingLog(NamedTuple):
    """A log that may still grow."""

    opened: Callable[[], Trace | None]  # what is whole of it; None where nothing is yet
    is_written: Callable[[], bool]  # whether somebody may write more


class _Shown(NamedTuple):
    rows: int
    room: scene.Extent
    scale: ForceScale | None


def follow(
    log: GrowingLog,
    stream: rr.RecordingStream,
    title: str,
    viewpoint: Viewpoint = DEFAULT_VIEW,
    rest: Callable[[float], None] = sleep,
) -> Trace | None:
    """Send a log to a stream until it is whole or nobody writes it; returns what there was at last.

    rest: waits so many seconds.
    """
    shown: _Shown | None = None
    while True:
        written = log.is_written()  # asked before it is read, so that nothing is missed at its end
        begin = monotonic()
        trace = log.opened()
        ended = not written or (trace is not None and not trace.damage)
        if trace is not None and len(trace.step):
            shown = _send(trace, stream, title, viewpoint, shown, ended)
        if ended:
            return trace
        rest(max(PAUSE, SHARE * (monotonic() - begin)))


def follow_file(
    path: Path,
    is_written: Callable[[], bool],
    title: str,
    viewpoint: Viewpoint,
    save_to: Path | None,
    copy: Path | None = None,
) -> None:
    """Show a file's log in a window, or write the recording of it, as it grows.

    copy: of the log, that is ahead of it until it is whole.
    """

    def opened() -> Trace | None:
        found = _whole_of(path)
        if copy is not None and (found is None or found.damage):
            return _whole_of(copy) or found
        return found

    stream = new_stream(title)
    log = GrowingLog(opened, is_written)
    try:
        if save_to is None:
            open_window(stream)
            _all_of(log, stream, title, viewpoint, path)
            return
        with written_aside(save_to) as unfinished:
            stream.save(unfinished)
            _all_of(log, stream, title, viewpoint, path)
            stream.disconnect()  # writes the footer that readers look for
    finally:
        stream.disconnect()


def _whole_of(path: Path) -> Trace | None:
    """Return what is whole of a log by now; None where it has not begun."""
    from lavendersim.trace import open_trace

    try:
        return open_trace(path, allow_incomplete=True)
    except (TraceError, FileNotFoundError):
        return None


def _all_of(
    log: GrowingLog, stream: rr.RecordingStream, title: str, viewpoint: Viewpoint, path: Path
) -> None:
    if follow(log, stream, title, viewpoint) is None:
        raise TraceError(f"{path}: nothing was written that could be shown")
    stream.flush(timeout_sec=60.0)


def _send(
    trace: Trace,
    stream: rr.RecordingStream,
    title: str,
    viewpoint: Viewpoint,
    shown: _Shown | None,
    ended: bool,
) -> _Shown:
    room, scale = measures_of(trace, scene.shapes(trace.config))
    rows = len(trace.step)
    same = shown is not None and (shown.room.diagonal, shown.scale) == (room.diagonal, scale)
    if shown is None or (not same and (ended or _outgrown(shown, room, scale))):
        record(trace, stream, title, viewpoint)
        return _Shown(rows, room, scale)
    columns.send(stream, trace, shown.room, shown.scale, since=shown.rows)
    return shown._replace(rows=rows)


def _outgrown(shown: _Shown, room: scene.Extent, scale: ForceScale | None) -> bool:
    """Whether what is drawn does not fit any more."""
    if room.diagonal > GROWTH * shown.room.diagonal:
        return True
    if scale is None or shown.scale is None:
        return scale is not shown.scale
    ratio = scale.newtons_per_metre / shown.scale.newtons_per_metre
    return not 1.0 / GROWTH <= ratio <= GROWTH
