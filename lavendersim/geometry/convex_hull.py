"""Convex hulls of points with flat faces: Qhull's triangles (Barber et al. 1996), merged by plane.

The hull itself is Qhull's (scipy). Its triangles that lie in one plane become one face, because a
face that is cut into triangles gives contacts that jump from one to the next.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from lavendersim.geometry.vectors import Vector3, cross, dot, minus, unit

# A hull thinner than this share of its largest extent has no sure inside in float64.
LEAST_THICKNESS = 1e-6
# Triangles are of one face when their normals differ by less than 1.4e-6 rad, and their planes by
# less than this share of the hull's extent.
SAME_NORMAL = 1.0 - 1e-12
SAME_PLANE = 1e-9


class Polyhedron(NamedTuple):
    """Corners [m], and faces as rows of corners that turn left seen from outside."""

    points: tuple[Vector3, ...]
    faces: tuple[tuple[int, ...], ...]


class FlatError(ValueError):
    """The points lie in one plane, on one line or in one point."""


def convex_hull(points: Sequence[Vector3]) -> Polyhedron:
    """Return the hull of points [m]; raises FlatError for points without a volume."""
    # 0.2 s that only scenes with hulls wait for
    from scipy.spatial import ConvexHull, QhullError

    extent = max(max(column) - min(column) for column in zip(*points, strict=True))
    try:
        found = ConvexHull(list(points)) if extent > 0.0 else None
    except QhullError:
        found = None
    if found is None:
        raise FlatError
    groups = _faces(found.simplices.tolist(), found.equations.tolist(), extent)
    loops = [_loop(points, members, normal, extent) for normal, members in groups]
    # Of points on an edge that are a rounding off it, Qhull makes triangles that turn anyhow.
    loops = [loop for loop in loops if len(loop) > 2]
    if not loops:  # of a needle each is a line, to a rounding
        raise FlatError
    used = sorted({corner for loop in loops for corner in loop})
    corners = tuple(points[corner] for corner in used)
    number = {corner: row for row, corner in enumerate(used)}
    faces = tuple(tuple(number[corner] for corner in loop) for loop in loops)
    if _thickness(corners, [normal for normal, _ in groups]) < LEAST_THICKNESS * extent:
        raise FlatError
    return Polyhedron(corners, faces)


def _faces(
    triangles: Iterable[list[int]], equations: Iterable[list[float]], extent: float
) -> list[tuple[Vector3, set[int]]]:
    """Return the planes of the hull, each with its points."""
    planes: list[tuple[Vector3, float, set[int]]] = []
    for triangle, (nx, ny, nz, height) in zip(triangles, equations, strict=True):
        normal = (nx, ny, nz)
        for other, other_height, members in planes:
            if (
                dot(normal, other) > SAME_NORMAL
                and abs(height - other_height) < SAME_PLANE * extent
            ):
                members.update(triangle)
                break
        else:
            planes.append((normal, height, set(triangle)))
    return [(normal, members) for normal, _, members in planes]


def _loop(
    points: Sequence[Vector3], members: Iterable[int], normal: Vector3, extent: float
) -> list[int]:
    """Return the corners of one face in order, by Graham's scan (1972) about its middle.

    Seen from inside, what lies on the line of an edge and beyond its ends comes before or after
    them, however its coordinates are rounded: it is measured against its own neighbours.
    """
    least = min(range(3), key=lambda axis: abs(normal[axis]))
    helper = [0.0, 0.0, 0.0]
    helper[least] = 1.0
    u = unit(cross((helper[0], helper[1], helper[2]), normal))
    v = cross(normal, u)
    flat = sorted((dot(points[row], u), dot(points[row], v), row) for row in members)
    x, y = (math.fsum(point[axis] for point in flat) / len(flat) for axis in (0, 1))
    flat.sort(key=lambda point: math.atan2(point[1] - y, point[0] - x))
    # The farthest from any place is a corner.
    first = max(range(len(flat)), key=lambda k: math.hypot(flat[k][0] - x, flat[k][1] - y))
    # A corner closer than this to the line of its neighbours is none of the face.
    straight = SAME_PLANE * extent
    loop: list[tuple[float, float, int]] = []
    for point in (*flat[first:], *flat[: first + 1]):
        while len(loop) > 1 and _bulge(loop[-2], loop[-1], point) <= straight:
            loop.pop()
        loop.append(point)
    loop.pop()  # the first again
    begin = loop.index(min(loop))
    return [row for _, _, row in (*loop[begin:], *loop[:begin])]


def _bulge(
    a: tuple[float, float, int], b: tuple[float, float, int], c: tuple[float, float, int]
) -> float:
    """Return how far b lies to the right of the line from a to c [m]; negative on the left."""
    x, y = c[0] - a[0], c[1] - a[1]
    length = math.hypot(x, y)
    return ((b[0] - a[0]) * y - (b[1] - a[1]) * x) / length if length else 0.0


def _thickness(corners: Sequence[Vector3], normals: Iterable[Vector3]) -> float:
    """Return the least distance of two parallel planes that hold the hull, one of them a face."""
    least = math.inf
    for normal in normals:
        heights = [dot(normal, minus(corner, corners[0])) for corner in corners]
        least = min(least, max(heights) - min(heights))
    return least
