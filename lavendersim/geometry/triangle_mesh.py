"""Surfaces of triangles: which hang together, by which sides, and what is no surface.

Corners of a triangle run counter-clockwise seen from outside: its normal is (b - a) x (c - a).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lavendersim.geometry.rotations import Floats

# Least height of a triangle over its longest side, in its length [-]: normals have ten digits then.
LEAST_HEIGHT = 1e-6
# How near to a side, in its length, a vertex lies on it [-].
ON_SIDE = 1e-9
# Sides at the rim up to which vertices on them are looked for: the time grows with their square.
MOST_RIM = 4000
Whole = np.ndarray  # int64


class MeshError(ValueError):
    """Triangles that make no surface; `triangle` is the row at fault."""

    def __init__(self, triangle: int, sentence: str) -> None:
        super().__init__(sentence)
        self.triangle = triangle


class TriangleSurface(NamedTuple):
    """A surface of T triangles and V vertices."""

    vertices: Floats  # (V, 3) [m]
    triangles: Whole  # (T, 3)
    normals: Floats  # (T, 3) unit
    beyond: Whole  # (T, 3) triangle across the side from corner k to the next; -1: none


def merged(vertices: Floats, triangles: Whole) -> tuple[Floats, Whole]:
    """Return vertices each of which stands at a place of its own, and the triangles of them."""
    places, rows = np.unique(vertices, axis=0, return_inverse=True)
    return places, rows.reshape(-1)[triangles]


def surface_of(vertices: ArrayLike, triangles: ArrayLike) -> TriangleSurface:
    """Return a surface; raises MeshError where triangles have no area or are no surface.

    vertices: (V, 3) [m]; vertices at one place are one. triangles: (T, 3) rows of them, which share
    whole sides; a vertex on one is found where at most MOST_RIM sides have no second triangle.
    """
    places, corners = merged(np.asarray(vertices, float), np.asarray(triangles, np.int64))
    a, b, c = (places[corners[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    double = np.linalg.norm(across, axis=1)
    longest = np.max([np.linalg.norm(v, axis=1) for v in (b - a, c - b, a - c)], axis=0)
    thin = np.flatnonzero(~(double > LEAST_HEIGHT * longest**2))
    if len(thin):
        raise MeshError(int(thin[0]), "its corners lie on a line")
    beyond = _beyond(corners)
    _check_rim(places, corners, beyond)
    return TriangleSurface(places, corners, across / double[:, None], beyond)


def _check_rim(places: Floats, corners: Whole, beyond: Whole) -> None:
    """Raise where a vertex lies on a side of a triangle that has no second one."""
    sides = np.flatnonzero(beyond.reshape(-1) < 0)
    if len(sides) > MOST_RIM:
        return
    start, end = corners.reshape(-1)[sides], np.roll(corners, -1, axis=1).reshape(-1)[sides]
    rim = np.unique(start)
    points = places[rim]
    for side, first, last in zip(sides.tolist(), start.tolist(), end.tolist(), strict=True):
        way = places[last] - places[first]
        off, square = points - places[first], float(way @ way)
        along = np.clip(off @ way / square, 0.0, 1.0)
        apart = off - along[:, None] * way
        on = np.einsum("ij,ij->i", apart, apart) <= ON_SIDE**2 * square
        on &= (rim != first) & (rim != last)
        if on.any():
            place = ", ".join(f"{x:.6g}" for x in points[np.argmax(on)])
            raise MeshError(
                side // 3,
                f"a vertex at ({place}) lies on one of its sides; expected triangles to share "
                "whole sides",
            )


def depth_behind(surface: TriangleSurface, point: Floats) -> float:
    """Return how far a point is behind the surface [m]; 0 in front of it, or beside its rim.

    That is decided where the surface is nearest, by the sum of the normals of all that meet there
    (Baerentzen and Aanaes 2005, who weigh them by angles: exact within faces and at edges).
    """
    start = surface.vertices[surface.triangles]  # (T, 3, 3)
    way = np.roll(start, -1, axis=1) - start
    off = point - start
    along = np.einsum("ijk,ijk->ij", off, way) / np.einsum("ijk,ijk->ij", way, way)
    inward = np.cross(surface.normals[:, None, :], way)
    over = (np.einsum("ijk,ijk->ij", off, inward) >= 0.0).all(axis=1)
    heights = np.einsum("ij,ij->i", off[:, 0], surface.normals)
    to_sides = np.linalg.norm(off - np.clip(along, 0.0, 1.0)[..., None] * way, axis=2)
    apart = np.where(over, np.abs(heights), to_sides.min(axis=1))
    least = float(apart.min())
    reach = least + ON_SIDE * float(np.abs(surface.vertices).max())
    at_rim = (to_sides <= reach) & (surface.beyond < 0)
    summed = surface.normals[apart <= reach].sum(axis=0)
    nearest = int(np.argmin(apart))
    side = int(np.argmin(to_sides[nearest]))
    foot = start[nearest, side] + np.clip(along[nearest, side], 0.0, 1.0) * way[nearest, side]
    if over[nearest]:
        foot = point - heights[nearest] * surface.normals[nearest]
    behind = float(summed @ (point - foot)) < 0.0 and not at_rim.any()
    return least if behind else 0.0


def _check_repeats(corners: Whole) -> None:
    """Raise where two triangles have the same corners and face the same way."""
    first = np.argmin(corners, axis=1)
    turned = corners[np.arange(len(corners))[:, None], (first[:, None] + np.arange(3)) % 3]
    _, earliest, which = np.unique(turned, axis=0, return_index=True, return_inverse=True)
    before = earliest[which.reshape(-1)]
    again = np.flatnonzero(before < np.arange(len(corners)))
    if len(again):
        raise MeshError(int(again[0]), f"it is triangle {before[again[0]]} again")


def _beyond(corners: Whole) -> Whole:
    _check_repeats(corners)
    start, end = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((high, low))
    same = (np.diff(low[order]) == 0) & (np.diff(high[order]) == 0)
    third = np.flatnonzero(same[1:] & same[:-1])
    if len(third):
        triangle = int(order[third[0] + 2]) // 3
        raise MeshError(triangle, "it is the third triangle at one of its sides; expected two")
    one, other = order[:-1][same], order[1:][same]
    alike = np.flatnonzero(start[one] == start[other])
    if len(alike):
        k = alike[0]
        triangle, neighbour = int(other[k]) // 3, int(one[k]) // 3
        raise MeshError(
            triangle,
            f"its corners run the other way round than those of triangle {neighbour}, beside it; "
            "expected all to run counter-clockwise seen from outside",
        )
    beyond = np.full(len(start), -1, np.int64)
    beyond[one], beyond[other] = other // 3, one // 3
    return beyond.reshape(-1, 3)
