"""The motion of a cell as data for the player of a page: corners of bodies, and their poses.

A sample of the logged states, some ten a second of playing, with four digits of the scene's size:
to look at, not to measure. Nothing of a config's words is in it.
"""

from __future__ import annotations

import json
from typing import Any, Final

import numpy as np

from lavendersim.cell import Plane
from lavendersim.figures.style import LOOKS
from lavendersim.figures.thumbnail import colour_of, grounds_of, parts_of, view_of
from lavendersim.geometry.periodic_cell import edges_of_cell, in_cell
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.measures.changes import removals

FRAMES: Final = 120  # states at most
NUMBERS: Final = 60_000  # of poses at most: some 400 kB of text
MOST_BODIES: Final = 300  # of a larger scene the first ones


def motion(trace: Any) -> str:
    """Return the sampled motion of a log as JSON; "" where fewer than two states are whole.

    `t`: times [s]; `right`, `up`: directions of the first view; `grounds`: [point, direction] of
    planes seen edge on; `cell`: both ends of the edges of a periodic cell; `bodies`, of a mesh its
    triangles: colour `c` ("none" of a cavity), corners `v` in the body's frame [m], whether
    `fixed`, and poses `p` [x, y, z, qw, qx, qy, qz], one a time, null where it is not there.
    """
    rows, poses = trace.recorded_pose
    poses = in_cell(poses, trace.config.scene.periodic)
    bodies = [trace.config.scene.bodies[name] for name in trace.bodies]
    solid = [i for i, body in enumerate(bodies) if not isinstance(body.shape, Plane)][:MOST_BODIES]
    whole = np.flatnonzero(np.isfinite(poses).all(axis=(1, 2)))
    if len(whole) < 2 or not solid:
        return ""
    count = max(2, min(FRAMES, NUMBERS // (7 * len(solid)), len(whole)))
    shown = whole[np.linspace(0, len(whole) - 1, count).round().astype(int)]
    right, up = view_of(trace)
    digits = _digits(poses[shown][:, solid, :3])
    gone = removals(trace)
    drawn = []
    for i in solid:
        body = bodies[i]
        kept = poses[shown[:1] if body.fixed else shown, i]
        last = gone.get(trace.bodies[i])
        drawn += [
            {
                "c": colour_of(body.shape) if body.fixed else LOOKS[i % len(LOOKS)].colour,
                "v": _rounded(part, digits),
                "fixed": body.fixed,
                "p": [
                    None
                    if last is not None and row >= last
                    else _rounded(pose[:3], digits) + _rounded(pose[3:], 4)
                    for row, pose in zip(rows[shown], kept, strict=False)
                ],
            }
            for part in parts_of(body.shape)
        ]
    planes = [
        [_rounded(point[0] * right + point[1] * up, digits), _rounded(level, 6)]
        for point, along in grounds_of(trace, right, up)
        for level in [along[0] * right + along[1] * up]
    ]
    radii = np.array([[bounding_radius(bodies[i].shape)] for i in solid])
    places = poses[shown][:, solid, :3]
    low, high = (places - radii).min(axis=(0, 1)), (places + radii).max(axis=(0, 1))
    edges = edges_of_cell(low, high, trace.config.scene.periodic)
    cell = [[_rounded(end, digits) for end in edge] for edge in edges]
    times = trace.step["time"][rows[shown]]
    data = {"t": _rounded(times, 6), "right": right.tolist(), "up": up.tolist(), "cell": cell}
    # A text within an element of its own: nothing in it may end that.
    text = json.dumps({**data, "grounds": planes, "bodies": drawn}, separators=(",", ":"))
    return text.replace("<", "\\u003c")


def _digits(places: np.ndarray) -> int:
    """Return decimals that show a ten-thousandth of the room that bodies take."""
    room = float(np.ptp(places.reshape(-1, 3), axis=0).max())
    return int(np.clip(4 - np.floor(np.log10(max(room, 1e-9))), 0, 12))


def _rounded(numbers: Any, digits: int) -> Any:
    return np.round(np.asarray(numbers, dtype=np.float64), digits).tolist()
