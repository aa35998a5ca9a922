"""The overlap of two convex polygons by trying every corner and every crossing of two sides."""

from __future__ import annotations

import numpy as np

# Corners of the overlap nearer to each other are one [m].
SAME = 1e-9


def crossing(p, q, r, s) -> np.ndarray | None:
    """Return where the segments p q and r s cross, if they do."""
    matrix = np.column_stack([q - p, r - s])
    if abs(np.linalg.det(matrix)) < 1e-12:
        return None
    t = np.linalg.solve(matrix, r - p)
    return p + t[0] * (q - p) if ((t >= 0.0) & (t <= 1.0)).all() else None


def inside(point: np.ndarray, polygon: np.ndarray) -> bool:
    """Whether a point lies in a convex polygon that turns left, to round-off."""
    sides = np.roll(polygon, -1, axis=0) - polygon
    to = point - polygon
    lengths = np.linalg.norm(sides, axis=1)
    return bool((sides[:, 0] * to[:, 1] - sides[:, 1] * to[:, 0] >= -1e-12 * lengths).all())


def overlap(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the corners of the overlap of two polygons (n, 2) that turn left, in no order."""
    found = [p for p in one if inside(p, other)] + [p for p in other if inside(p, one)]
    for k in range(len(one)):
        for i in range(len(other)):
            point = crossing(one[k], one[(k + 1) % len(one)], other[i], other[(i + 1) % len(other)])
            if point is not None:
                found.append(point)
    corners: list[np.ndarray] = []
    for point in found:
        if all(np.linalg.norm(point - known) > SAME for known in corners):
            corners.append(point)
    return np.array(corners).reshape(-1, 2)


def are_same(found: np.ndarray, expected: np.ndarray, tolerance: float) -> bool:
    """Whether two sets of points are equal, each with a twin in the other."""
    if not len(found) or not len(expected):
        return len(found) == len(expected)
    distance = np.linalg.norm(found[:, None] - expected[None], axis=2)
    return bool(distance.min(axis=0).max() <= tolerance and distance.min(axis=1).max() <= tolerance)
