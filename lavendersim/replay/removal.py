"""Bodies that are removed during a run vanish from the picture at that time.

What is static in rerun cannot be cleared: a body that will be gone is drawn at the first time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import rerun as rr

from lavendersim.measures.changes import removals
from lavendersim.replay.layer import ALONE, Layer
from lavendersim.replay.timeline import at_time

if TYPE_CHECKING:
    from lavendersim.trace import Trace


def removed(trace: Trace) -> dict[str, int]:
    """The row of the first state without it, for each body that a log sees removed."""
    return {name: row for name, row in removals(trace).items() if row < len(trace.step)}


def clear_removed(
    stream: rr.RecordingStream,
    trace: Trace,
    times: npt.NDArray[np.int64],
    folders: list[str],
    layer: Layer = ALONE,
) -> None:
    """Let bodies vanish, with all that is drawn of them in these folders; times: of rows [ns]."""
    for name, row in removed(trace).items():
        with at_time(stream, int(times[row])):
            for folder in folders:
                stream.log(layer.path(folder, name), rr.Clear(recursive=True))
