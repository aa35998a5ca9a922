"""Signed separation of two convex shapes: slow, in numpy, by other methods than the engine's.

A box here is a set of eight corners. For two convex polytopes the signed separation is the largest,
over unit directions n, of `min_B n . x - max_A n . x`; when they overlap it is reached at a face
normal or at the cross product of two edges. When they are apart the same number bounds the distance
from below, and a pair of points found by alternating projections bounds it from above.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np


class Box(NamedTuple):
    """Centre [m], body-to-world matrix, half edge lengths [m]."""

    centre: np.ndarray
    matrix: np.ndarray
    half: np.ndarray


def corners(box: Box) -> np.ndarray:
    """Return the eight corners, shape (8, 3)."""
    signs = np.array(list(product((-1.0, 1.0), repeat=3)))
    return box.centre + (signs * box.half) @ box.matrix.T


def candidate_axes(a: Box, b: Box) -> np.ndarray:
    """Return the unit directions that decide whether two boxes overlap, both signs of each."""
    axes = [*a.matrix.T, *b.matrix.T]
    for u, w in product(a.matrix.T, b.matrix.T):
        cross = np.cross(u, w)
        length = np.linalg.norm(cross)
        if length > 1e-8:  # parallel edges: a face normal says the same
            axes.append(cross / length)
    axes = np.array(axes)
    return np.concatenate([axes, -axes])


def gap_along(a: Box, b: Box, axes: np.ndarray) -> np.ndarray:
    """Return min over B minus max over A of n . x, for every row n of `axes`; n leads A to B."""
    return np.min(axes @ corners(b).T, axis=1) - np.max(axes @ corners(a).T, axis=1)


def box_box_separation(a: Box, b: Box) -> float:
    """Return minus the penetration depth when they overlap, else a lower bound of the distance."""
    return float(np.max(gap_along(a, b, candidate_axes(a, b))))


def nearest_in_box(box: Box, point: np.ndarray) -> np.ndarray:
    """Return the point of the solid box nearest to `point`."""
    local = box.matrix.T @ (point - box.centre)
    return box.centre + box.matrix @ np.clip(local, -box.half, box.half)


def box_box_distance(a: Box, b: Box, rounds: int = 2000) -> float:
    """Return an upper bound of the distance that alternating projections take to its limit."""
    q = b.centre
    for _ in range(rounds):
        p = nearest_in_box(a, q)
        q = nearest_in_box(b, p)
    return float(np.linalg.norm(p - q))


def sphere_box_separation(box: Box, centre: np.ndarray, radius: float) -> float:
    """Signed distance of a point to a box (outside norm plus inside maximum), less the radius."""
    over = np.abs(box.matrix.T @ (centre - box.centre)) - box.half
    outside = float(np.linalg.norm(np.maximum(over, 0.0)))
    return outside + min(float(np.max(over)), 0.0) - radius


def depth_in_box(box: Box, point: np.ndarray) -> float:
    """Return how far `point` lies outside the solid box (0 inside) [m]."""
    return float(np.linalg.norm(point - nearest_in_box(box, point)))


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    """Return a rotation matrix, uniform over all."""
    return matrix_of(rng.normal(size=4))


def matrix_of(quaternion: np.ndarray) -> np.ndarray:
    """Return the matrix of a quaternion w x y z by the sandwich product q (0, e_i) q*."""
    w, *vector = np.asarray(quaternion, float) / np.linalg.norm(quaternion)
    u = np.array(vector)
    columns = [e + 2.0 * w * np.cross(u, e) + 2.0 * np.cross(u, np.cross(u, e)) for e in np.eye(3)]
    return np.array(columns).T
