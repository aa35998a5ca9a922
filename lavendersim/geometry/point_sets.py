"""Whether the convex hulls of two sets of points meet: GJK (Gilbert, Johnson, Keerthi 1988).

For a few pairs, in numpy; kernels have their own (`engine/collide/convex`).
"""

from __future__ import annotations

from itertools import combinations
from typing import Final

import numpy as np

from lavendersim.geometry.rotations import Floats

MOST_ROUNDS: Final = 64


def hulls_meet(one: Floats, other: Floats) -> bool:
    """Return whether the hulls of two point sets (n, 3), (m, 3) have a point in common.

    Only a plane that separates them says no: where round-off hides it, as it does where they are
    nearer than 1e-8 of their size, they meet.
    """
    difference = (one[:, None] - other[None]).reshape(-1, 3)
    size = float(np.abs(difference).max())
    nearest = difference[0]
    simplex = difference[:1]
    for _ in range(MOST_ROUNDS):
        if float(nearest @ nearest) <= (1e-12 * size) ** 2:
            return True
        support = difference[np.argmin(difference @ nearest)]
        if float(support @ nearest) > 0.0:
            return False
        simplex, nearest = _nearest(np.vstack([simplex, support]))
    return True


def _nearest(points: Floats) -> tuple[Floats, Floats]:
    """Return the points of a simplex whose hull has the point nearest to the origin, and that one.

    points: (k, 3), k <= 4 or one more, of which some are left out. By trying every face.
    """
    best, found, least = points[:1], points[0], float(points[0] @ points[0])
    for count in range(1, min(len(points), 4) + 1):
        for rows in combinations(range(len(points)), count):
            face = points[list(rows)]
            edges = (face[1:] - face[0]).T
            weights = np.linalg.lstsq(edges, -face[0], rcond=None)[0] if count > 1 else np.zeros(0)
            if np.any(weights < 0.0) or weights.sum() > 1.0:
                continue
            point = face[0] + edges @ weights if count > 1 else face[0]
            square = float(point @ point)
            if square < least:
                best, found, least = face, point, square
    return best, found
