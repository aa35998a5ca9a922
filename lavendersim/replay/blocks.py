"""Rerun columns, sent in blocks of many steps.

A call per step costs rerun some 20 us and a chunk of its own, a block costs the same once.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy.typing as npt
import rerun as rr

from lavendersim.replay.timeline import TIMELINE

# Small enough for the viewer to fetch what it shows, large enough to make the calls' cost vanish.
STEPS_PER_BLOCK = 200


def blocks(rows: int) -> Iterator[slice]:
    """Cut `rows` into slices of STEPS_PER_BLOCK; the last may be shorter."""
    for start in range(0, rows, STEPS_PER_BLOCK):
        yield slice(start, min(start + STEPS_PER_BLOCK, rows))


def send_columns(
    stream: rr.RecordingStream,
    path: str,
    times: npt.NDArray[Any],
    columns: rr.ComponentColumnList,
) -> None:
    """Send columns of an entity at these times."""
    # strict: rerun otherwise turns a mistake of ours into a warning and drops the data
    index = rr.TimeColumn(TIMELINE, duration=times)
    stream.send_columns(path, indexes=[index], columns=columns, strict=True)
