"""The uneven ground that one drawn scene of eight lies over: at rest, carried on, or turning.

It is drawn from a seed of its own, so that all other scenes stay what they are. Some body is just
over it, or in it by less than half; a ground may be smaller than the bodies, or have them all.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from fuzz_drives import set_in_motion

EVERY = 8  # of so many scenes one has a ground, in the mean


def ground(pen: Any, bodies: dict[str, Any], sizes: dict[str, float]) -> None:
    """Add a height field or a mesh under bodies, in most scenes none; pen: of another seed."""
    if "cavity" in bodies or pen.integer(1, EVERY) > 1:
        return
    over = pen.one_of([*sizes])
    size, at = sizes[over], np.array(bodies[over]["position"])
    spacing = size * pen.power(-1.0, 1.0)
    counts = pen.integer(2, 5), pen.integer(2, 5)
    steep = pen.one_of((0.0, 0.3, 1.5)) * spacing
    heights = [[steep * pen.share() for _ in range(counts[1])] for _ in range(counts[0])]
    shape: dict[str, Any] = {"kind": "height_field", "heights": heights, "spacing": [spacing] * 2}
    if pen.coin():
        shape = pointed(spacing, steep)
    down = np.array(pen.some_vector(0.0, 0.0))
    down *= size * (1.5 - pen.share()) / np.linalg.norm(down)
    body: dict[str, Any] = {
        "shape": shape,
        "position": (at - down).tolist(),
        "orientation": pen.turn(),
        "surface": pen.surface(size),
    }
    set_in_motion(pen, body, 1.0)
    bodies["ground"] = body


def pointed(width: float, height: float) -> dict[str, Any]:
    """Return a closed mesh: an octahedron, flat where it has no height."""
    tall = max(height, 0.3 * width)
    corners = [[width, 0.0, 0.0], [0.0, width, 0.0], [-width, 0.0, 0.0], [0.0, -width, 0.0]]
    sides = [[k, (k + 1) % 4, 4] for k in range(4)]
    below = [[(k + 1) % 4, k, 5] for k in range(4)]
    ends = [[0.0, 0.0, tall], [0.0, 0.0, -tall]]
    return {"kind": "mesh", "vertices": corners + ends, "triangles": sides + below}
