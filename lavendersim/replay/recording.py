"""The rerun recording of a log with its blueprint, to a stream or a file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from lavendersim.durable_files import written_aside
from lavendersim.errors import UsageError
from lavendersim.replay import columns, scene
from lavendersim.replay.blueprint import blueprint
from lavendersim.replay.camera import camera_of
from lavendersim.replay.force_scale import ForceScale, force_scale, scene_size
from lavendersim.replay.pair import LogPair
from lavendersim.replay.pair_recording import record_pair
from lavendersim.replay.viewpoint import DEFAULT_VIEW, Viewpoint

if TYPE_CHECKING:
    from lavendersim.trace import Trace


def new_stream(title: str) -> rr.RecordingStream:
    """A recording stream that goes nowhere yet.

    The viewer keeps one blueprint per application, so each title is an application of its own:
    a second replay in an open viewer leaves the first one's camera alone. The viewer takes names
    of letters, digits, hyphens and underscores; it renames and warns about all others.
    """
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", f"lavender-{title}")
    return rr.RecordingStream(name)


def record(
    trace: Trace | LogPair,
    stream: rr.RecordingStream,
    title: str,
    viewpoint: Viewpoint = DEFAULT_VIEW,
) -> None:
    """Send the whole trace, or two, and the layout of the viewer to `stream`."""
    if isinstance(trace, LogPair):
        record_pair(trace, stream, title, viewpoint)
        return
    bodies = scene.shapes(trace.config)
    room, scale = measures_of(trace, bodies)
    stream.send_recording_name(title)
    camera = camera_of(trace, bodies, room, viewpoint)
    stream.send_blueprint(blueprint(trace, bodies, room, scale, camera, viewpoint.speed))
    scene.draw(stream, trace, bodies, scene.Stage(room, camera))
    columns.send(stream, trace, room, scale)


def measures_of(
    trace: Trace, bodies: Sequence[scene.DrawnBody]
) -> tuple[scene.Extent, ForceScale | None]:
    """Return the room that bodies take, and how long forces are drawn; None where none can act."""
    room = scene.extent(trace, bodies)
    # Where nothing can touch there are no contacts to place and no forces to scale.
    touching = trace.has("/contacts")
    if not touching:
        return room, None
    return room, force_scale(columns.contacts_of(trace), scene_size(room.diagonal, bodies))


def write_rrd(
    trace: Trace | LogPair, path: Path, title: str, viewpoint: Viewpoint = DEFAULT_VIEW
) -> None:
    """Write the recording beside `path` and move it there when it is whole."""
    stream = new_stream(title)
    try:
        with written_aside(path) as unfinished:
            stream.save(unfinished)
            record(trace, stream, title, viewpoint)
            stream.flush()
            stream.disconnect()  # writes the footer that readers look for
    finally:
        stream.disconnect()


def moment_to_show(trace: Trace | LogPair, at: float | None = None) -> np.timedelta64:
    """The step nearest to `at` [s]; without one the last with a contact force, or the middle.

    Of two logs those of the first.

    Raises UsageError for a time that the log does not reach.
    """
    if isinstance(trace, LogPair):
        trace = trace.a
    times = columns.time_in_nanoseconds(trace)
    if at is not None:
        first, last = (float(times[row]) * 1e-9 for row in (0, -1))
        half = 0.5 * float(trace.clock.longest)
        if not first - half <= at <= last + half:
            raise UsageError(f"{at:.9g} s: this log goes from {first:g} to {last:.9g} s")
        nearest = int(np.argmin(np.abs(times - at * 1e9)))
        return np.timedelta64(int(times[nearest]), "ns")
    contact = columns.contacts_of(trace)
    loaded = contact["step"][np.isfinite(contact["force_n"]) & (contact["force_n"] > 0)]
    row = np.searchsorted(trace.step["step"], loaded[-1]) if len(loaded) else len(times) // 2
    return np.timedelta64(int(times[row]), "ns")
