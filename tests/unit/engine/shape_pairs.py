"""Random poses of a shape pair: body records, signed separations, distances from the surfaces.

Lengths lie between e^-2 and 1 m, the origin within a few metres: one round-off is some 1e-15 m.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import convex
import numpy as np
import poses

from lavendersim.engine.records import TOUCHING

ALL = ("sphere_plane", "box_plane", "sphere_sphere", "sphere_box", "box_box")
POSES = 2000
# A few hundred operations on lengths of some metres, each rounded to 1.1e-16.
ROUND_OFF = 1e-13
# Faces are cut one TOUCHING outside their edges, which keeps names of vertices, and the points are
# moved back to the face: each may be that much too deep, and off the incident face.
CUT = 1.5 * TOUCHING


class Poses(NamedTuple):
    """Rows of the two bodies, what the oracle says, and how far a point is from each surface."""

    first: np.ndarray
    second: np.ndarray
    separation: np.ndarray
    off_first: list[Callable[[np.ndarray], float]]  # distance to the surface or inside of A [m]
    off_second: list[Callable[[np.ndarray], float]]
    found: list[poses.Manifold]


def _shape(kind: str, rng: np.random.Generator, i: int, near: convex.Box | None):
    """Return (half, centre, matrix, offset) of one random body."""
    if kind == "plane":
        normal = rng.normal(size=3)
        return normal / np.linalg.norm(normal), np.zeros(3), np.eye(3), rng.normal()
    half = np.exp(rng.uniform(-2.0, 0.0, 3))
    if kind == "sphere":
        half = half[:1]
    matrix = convex.random_rotation(rng)
    if near is None:
        return half, rng.normal(size=3), matrix, 0.0
    if i % 3 == 0:
        matrix = near.matrix.copy()  # parallel faces and edges
    direction = rng.normal(size=3)
    reach = np.linalg.norm(near.half) + np.linalg.norm(half)
    offset = direction / np.linalg.norm(direction) * rng.uniform(0.0, 1.4 * reach)
    return half, near.centre + offset, matrix, 0.0


def _separation(kinds, a, b) -> float:
    if kinds[0] == "plane":
        normal, offset = a[0], a[3]
        if kinds[1] == "sphere":
            return float(normal @ b[1] - offset - b[0][0])
        return float(np.min(convex.corners(convex.Box(b[1], b[2], b[0])) @ normal) - offset)
    if kinds == ("sphere", "sphere"):
        return float(np.linalg.norm(b[1] - a[1]) - a[0][0] - b[0][0])
    box = convex.Box(a[1], a[2], a[0])
    if kinds[1] == "sphere":
        return convex.sphere_box_separation(box, b[1], float(b[0][0]))
    return convex.box_box_separation(box, convex.Box(b[1], b[2], b[0]))


def _off(kind: str, shape) -> Callable[[np.ndarray], float]:
    half, centre, matrix, offset = shape
    if kind == "plane":
        return lambda p: abs(float(half @ p - offset))
    if kind == "sphere":
        return lambda p: abs(float(np.linalg.norm(p - centre) - half[0]))
    solid = convex.Box(centre, matrix, half)
    return lambda p: abs(convex.sphere_box_separation(solid, p, 0.0))


@cache
def random_poses(pair: str) -> Poses:
    """Return 2000 poses, about half of them touching, with what both sides say of them."""
    kinds = poses.SHAPE_PAIRS[pair].shapes
    rng = np.random.default_rng(sum(pair.encode()))
    first, second = poses.allocate(POSES), poses.allocate(POSES)
    separation, off_first, off_second = np.zeros(POSES), [], []
    for i in range(POSES):
        a = _shape(kinds[0], rng, i, None)
        near = None if kinds[0] == "plane" else convex.Box(a[1], a[2], a[0])
        b = _shape(kinds[1], rng, i, near)
        poses.put(first[i], *a)
        poses.put(second[i], *b)
        separation[i] = _separation(kinds, a, b)
        off_first.append(_off(kinds[0], a))
        off_second.append(_off(kinds[1], b))
    found = poses.manifolds(pair, first, second)
    return Poses(first, second, separation, off_first, off_second, found)
