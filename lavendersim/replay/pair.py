"""Two logs that are shown together, and the distance of each body from itself in the other.

Bodies are the same by their names; distances are those of centres, at times that both logs have.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.poses import distances

if TYPE_CHECKING:
    from lavendersim.trace import Trace

# A run's directory: its time, what ran in it, a digest. What is behind, a cell's label, stays.
_STAMP: Final = r"^\d{8}T\d{6}Z(\.\d{3})?-"
_DIGEST: Final = r"-[0-9a-f]{8}(?= |$)"
MOST_CURVES: Final = 8  # of the bodies that come farthest: more cannot be distinguished


class LogPair(NamedTuple):
    """Two logs. overlay: the second as a ghost over the first; otherwise side by side."""

    a: Trace
    b: Trace
    name_a: str
    name_b: str
    overlay: bool = False

    @property
    def path(self) -> Path:
        """Where the first log is."""
        return self.a.path

    @property
    def short_names(self) -> tuple[str, str]:
        """The names without times and digests, where these tell them apart: titles have no room."""
        names = self.name_a, self.name_b
        for left_out in (f"{_STAMP}|{_DIGEST}", _STAMP):
            a, b = (re.sub(left_out, "", name) for name in names)
            if a != b:
                return a, b
        return names


class Distance(NamedTuple):
    """The distance [m] of a body from itself in the other log, at common times."""

    body: str
    place: int  # among the movable bodies of the first log, which have their colours by it
    metres: npt.NDArray[np.float64]


class Distances(NamedTuple):
    """Distances of bodies, the one that comes farthest first; times [ns]."""

    times: npt.NDArray[np.int64]
    bodies: list[Distance]


def distances_of(pair: LogPair) -> Distances:
    """Return the distances of the bodies that both logs have and that can move."""
    given = pair.a.config.scene.bodies
    movable = [name for name in pair.a.bodies if is_movable(given[name])]
    at_a, at_b = (one.step["time_ns"][one.recorded_pose.rows] for one in (pair.a, pair.b))
    times, rows_a, rows_b = np.intersect1d(at_a, at_b, return_indices=True)
    found = []
    for place, name in enumerate(movable):
        if name not in pair.b.bodies:
            continue
        left = pair.a.recorded_pose.pose[rows_a, pair.a.bodies.index(name)]
        right = pair.b.recorded_pose.pose[rows_b, pair.b.bodies.index(name)]
        found.append(Distance(name, place, distances(left, right)))
    found.sort(key=lambda one: -_largest(one))
    return Distances(np.asarray(times, np.int64), found[:MOST_CURVES])


def _largest(one: Distance) -> float:
    known = one.metres[np.isfinite(one.metres)]
    return float(known.max()) if len(known) else 0.0
