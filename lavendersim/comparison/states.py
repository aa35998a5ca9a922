"""The first step at which the states of two logs part, to the bit, and by how much.

States are those of equal times. Where their steps have equal numbers, the hash of `/step` says of
poses and velocities together whether they are equal; the poses say which bodies part, and where.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.geometry.poses import distances, turns
from lavendersim.trace import Trace

Rows = NDArray[np.intp]
POSES, VELOCITIES, LENGTH, NOTHING = "poses", "velocities", "length", "nothing"


class Apart(NamedTuple):
    """How far a body is from itself in the other log."""

    body: str
    metres: float
    radians: float


class Parting(NamedTuple):
    """Where two logs part. differs: NOTHING, POSES, VELOCITIES (not yet poses) or LENGTH."""

    differs: str
    steps: int  # that are at equal times in both
    step: int | None = None  # of the first log
    time: float | None = None  # [s]
    bodies: tuple[Apart, ...] = ()  # the farthest first, at the first step whose poses differ
    posed: float | None = None  # [s] the time of that step
    farthest: Apart | None = None  # of all steps
    only_a: tuple[str, ...] = ()  # bodies that the other log has not
    only_b: tuple[str, ...] = ()


def parting(a: Trace, b: Trace) -> Parting:
    """Return where the states of two logs part."""
    times, rows_a, rows_b = np.intersect1d(
        a.step["time_ns"], b.step["time_ns"], return_indices=True
    )
    only_a = tuple(name for name in a.bodies if name not in b.bodies)
    only_b = tuple(name for name in b.bodies if name not in a.bodies)
    hashed = _first_hash(a, b, rows_a, rows_b)
    posed, bodies, farthest = _first_pose(a, b)
    known = [time for time in (hashed, posed) if time is not None]
    if not known:
        same = len(times) == len(a.step) == len(b.step) and not only_a and not only_b
        found = NOTHING if same else LENGTH
        return Parting(found, len(times), only_a=only_a, only_b=only_b)
    first = min(known)
    row = int(np.searchsorted(a.step["time_ns"], first))
    return Parting(
        POSES if posed == first else VELOCITIES,
        len(times),
        int(a.step["step"][row]),
        first * 1e-9,
        bodies,
        None if posed is None else posed * 1e-9,
        farthest,
        only_a,
        only_b,
    )


def _first_hash(a: Trace, b: Trace, rows_a: Rows, rows_b: Rows) -> int | None:
    """Return the first time [ns] at which hashes differ; None too where they cannot be compared.

    A hash begins with the number of its step, and is of all bodies.
    """
    names = ("step", "state_hash")
    if a.bodies != b.bodies or any(
        name not in (trace.step.dtype.names or ()) for trace in (a, b) for name in names
    ):
        return None
    left, right = a.step[rows_a], b.step[rows_b]
    if not np.array_equal(left["step"], right["step"]):
        return None
    apart = np.flatnonzero(left["state_hash"] != right["state_hash"])
    return int(left["time_ns"][apart[0]]) if len(apart) else None


def _first_pose(a: Trace, b: Trace) -> tuple[int | None, tuple[Apart, ...], Apart | None]:
    """Return the first time [ns] at which poses differ, the bodies then, the farthest of all."""
    names = [name for name in a.bodies if name in b.bodies]
    if not names or not (a.has("/tf") and b.has("/tf")):
        return None, (), None
    at_a, at_b = (t.step["time_ns"][t.recorded_pose.rows] for t in (a, b))
    times, rows_a, rows_b = np.intersect1d(at_a, at_b, return_indices=True)
    left, right = (
        trace.recorded_pose.pose[rows][:, [trace.bodies.index(name) for name in names]]
        for trace, rows in ((a, rows_a), (b, rows_b))
    )
    differs = (left.view(np.uint64) != right.view(np.uint64)).any(axis=2)  # (rows, bodies)
    rows = np.flatnonzero(differs.any(axis=1))
    if not len(rows):
        return None, (), None
    metres = distances(left, right)
    first = int(rows[0])
    angles = turns(left[first], right[first])
    bodies = [
        Apart(names[k], float(metres[first, k]), float(angles[k]))
        for k in np.flatnonzero(differs[first])
    ]
    bodies.sort(key=lambda one: -one.metres)
    known = np.where(np.isfinite(metres), metres, -1.0)
    row, body = np.unravel_index(int(np.argmax(known)), metres.shape)
    angle = float(turns(left[row, body], right[row, body]))
    return int(times[first]), tuple(bodies), Apart(names[body], float(metres[row, body]), angle)
