"""Depth of overlap of two solids in place, from geometry alone: separating axes, nearest points.

The depth is the shortest translation that parts the two solids, negative where they are apart (then
no more than the distance between them). All functions are vectorised over pairs.

Spheres and capsules: sum of the radii less the distance of centres or axes. Sphere and box: the
nearest point of the box. Boxes: separating axes. The Minkowski difference of two boxes is a convex
polytope whose faces have the 3 + 3 face normals and the 3 x 3 products of edges as normals, and the
depth is the least distance from the origin to one of these faces, so the fifteen axes give it
exactly. Edges nearer to parallel than 1e-8 are left out: their face is narrower than 1e-8 times an
edge, and so is the error.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from lavendersim.measures.interfaces import Floats
from lavendersim.measures.solids import BOX, CAPSULE, SPHERE, PlacedSolids

PARALLEL: Final = 1e-8
AHEAD = np.array([1, 2, 0])  # the next axis, cyclically
BEHIND = np.array([2, 0, 1])


def depths(kind_a: int, kind_b: int, a: PlacedSolids, b: PlacedSolids) -> Floats:
    """Return the depth [m] of each pair; NaN for shapes without a closed form here."""
    if kind_a > kind_b:
        kind_a, kind_b, a, b = kind_b, kind_a, b, a
    known = DEPTHS.get((kind_a, kind_b))
    return np.full(len(a.position), np.nan) if known is None else known(a, b)


def sphere_sphere(a: PlacedSolids, b: PlacedSolids) -> Floats:
    """Radii less the distance of the centres."""
    return a.size[:, 0] + b.size[:, 0] - _length(b.position - a.position)


def sphere_box(sphere: PlacedSolids, box: PlacedSolids) -> Floats:
    """From the nearest point of the box; inside it, from its nearest face."""
    local = np.einsum("pji,pj->pi", box.rotation, sphere.position - box.position)
    outside = _length(local - np.clip(local, -box.size, box.size))
    inside = np.min(box.size - np.abs(local), axis=1)
    return sphere.size[:, 0] + np.where(outside > 0.0, -outside, inside)


def sphere_capsule(sphere: PlacedSolids, capsule: PlacedSolids) -> Floats:
    """From the nearest point of the capsule's axis."""
    axis, half = capsule.rotation[:, :, 2], capsule.size[:, 2]
    apart = sphere.position - capsule.position
    along = np.clip(np.einsum("pi,pi->p", apart, axis), -half, half)
    return sphere.size[:, 0] + capsule.size[:, 0] - _length(apart - along[:, None] * axis)


def capsule_capsule(a: PlacedSolids, b: PlacedSolids) -> Floats:
    """From the nearest points of both axes: inside both, or at one of the four ends."""
    u, v = a.rotation[:, :, 2], b.rotation[:, :, 2]
    half_a, half_b = a.size[:, 2], b.size[:, 2]
    apart = b.position - a.position
    uv = np.einsum("pi,pi->p", u, v)
    du, dv = np.einsum("pi,pi->p", apart, u), np.einsum("pi,pi->p", apart, v)
    sine = 1.0 - uv * uv
    with np.errstate(divide="ignore", invalid="ignore"):
        inner = np.where(sine > 0.0, (du - uv * dv) / sine, 0.0)
    distances = []
    for s in (np.clip(inner, -half_a, half_a), -half_a, half_a):
        t = np.clip(s * uv - dv, -half_b, half_b)
        distances.append(_between(apart, s, u, t, v))
    for t in (-half_b, half_b):
        s = np.clip(t * uv + du, -half_a, half_a)
        distances.append(_between(apart, s, u, t, v))
    depth: Floats = a.size[:, 0] + b.size[:, 0] - np.min(distances, axis=0)
    return depth


def box_box(a: PlacedSolids, b: PlacedSolids) -> Floats:
    """Least overlap over the fifteen separating axes."""
    turn = np.einsum("pji,pjk->pik", a.rotation, b.rotation)  # axes of B in the frame of A
    apart = np.einsum("pji,pj->pi", a.rotation, b.position - a.position)
    size = np.abs(turn)
    faces_a = a.size + np.einsum("pij,pj->pi", size, b.size) - np.abs(apart)
    along_b = np.einsum("pij,pi->pj", turn, apart)
    faces_b = b.size + np.einsum("pij,pi->pj", size, a.size) - np.abs(along_b)
    edges = _edge_overlaps(a.size, b.size, turn, apart)
    depth: Floats = np.min(np.concatenate([faces_a, faces_b, edges], axis=1), axis=1)
    return depth


def _edge_overlaps(half_a: Floats, half_b: Floats, turn: Floats, apart: Floats) -> Floats:
    """Overlap along e_i x b_j for all nine (i, j): (pairs, 9), inf for parallel edges.

    In the frame of A the product has the components -R[i+2, j] along i+1 and R[i+1, j] along i+2.
    """
    ahead, behind, size = turn[:, AHEAD, :], turn[:, BEHIND, :], np.abs(turn)
    reach_a = half_a[:, AHEAD, None] * np.abs(behind) + half_a[:, BEHIND, None] * np.abs(ahead)
    reach_b = half_b[:, None, AHEAD] * size[:, :, BEHIND]
    reach_b += half_b[:, None, BEHIND] * size[:, :, AHEAD]
    gap = np.abs(apart[:, BEHIND, None] * ahead - apart[:, AHEAD, None] * behind)
    length = np.sqrt(ahead * ahead + behind * behind)
    with np.errstate(divide="ignore", invalid="ignore"):
        overlap = (reach_a + reach_b - gap) / length
    return np.where(length > PARALLEL, overlap, np.inf).reshape(len(turn), 9)


def _between(apart: Floats, s: Floats, u: Floats, t: Floats, v: Floats) -> Floats:
    return _length(apart + t[:, None] * v - s[:, None] * u)


def _length(vectors: Floats) -> Floats:
    lengths: Floats = np.sqrt(np.einsum("pi,pi->p", vectors, vectors))
    return lengths


DEPTHS: Final[dict[tuple[int, int], Callable[[PlacedSolids, PlacedSolids], Floats]]] = {
    (SPHERE, SPHERE): sphere_sphere,
    (SPHERE, BOX): sphere_box,
    (SPHERE, CAPSULE): sphere_capsule,
    (BOX, BOX): box_box,
    (CAPSULE, CAPSULE): capsule_capsule,
}
