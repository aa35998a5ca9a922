"""Random poses of pairs of shapes, and their manifolds.

One kernel serves all pairs. It is composed of every pair with contacts ahead of touching, as a
scene with all shapes would have it; it is kept on disk like the engine's own.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import convex
import numpy as np
import poses
import solids
from scipy.spatial import ConvexHull

from lavendersim.engine.collide import SHAPE_PAIRS, narrow_phase
from lavendersim.engine.collide.convex.hull_geometry import hull_geometry
from lavendersim.engine.collide.convex.separation import make_separation
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.compile import kernel
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import POINT, dtype
from lavendersim.engine.spec import Spec

_TEXT = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]
# Cavities and meshes are no convex bodies: tests/unit/engine/cavity_contacts.py, mesh_contacts.py.
PAIRS = tuple(sorted(name for name, pair in SHAPE_PAIRS.items() if not pair.own_normals))
EVERY_SHAPE = Spec(
    effects=("rotation", "speculative"), shape_pairs=PAIRS, solver=f"solid poses {_TEXT}"
)
NEW_PAIRS = tuple(name for name in PAIRS if SHAPE_PAIRS[name].kind > 4)


class Sample(NamedTuple):
    """Rows of two bodies, their solids, and the hulls they may be."""

    pair: str
    first: np.ndarray
    second: np.ndarray
    hulls: list

    def solids(self, i: int) -> tuple[solids.Solid, solids.Solid]:
        """Return what row i of both sides is."""
        return (
            solids.solid_of(self.first[i], self.hulls),
            solids.solid_of(self.second[i], self.hulls),
        )


@cache
def every_pose(spec: Spec = EVERY_SHAPE) -> Any:
    """Return `kernel(kind, first, second, found, normals, counts, margin, scratch)`."""

    def compose(spec: Spec) -> Any:
        manifold = narrow_phase.make_manifold(spec, spec.shape_pairs)

        def run(kind, first, second, found, normals, counts, margin, scratch):
            for i in range(first.shape[0]):
                count = manifold(kind, first[i], second[i], margin, scratch)
                counts[i] = count
                for k in range(3):
                    normals[i, k] = scratch.manifold.normal[k]
                for k in range(count):
                    row, point = found[4 * i + k], scratch.manifold.points[k]
                    row.x, row.y, row.z = point.x, point.y, point.z
                    row.phi, row.feature = point.phi, point.feature

        return kernel(run, spec)

    return cached(compose, spec)


@cache
def every_separation() -> Any:
    """Return `kernel(kind, first, second, found, scratch)`, which fills (distance, normal) rows."""

    def compose(spec: Spec) -> Any:
        separation = make_separation(spec)

        def run(kind, first, second, found, scratch):
            for i in range(first.shape[0]):
                distance, n = separation(kind, first[i], second[i], scratch)
                found[i, 0], found[i, 1], found[i, 2], found[i, 3] = distance, n.x, n.y, n.z

        return kernel(run, spec)

    return cached(compose, EVERY_SHAPE._replace(solver=f"separations {_TEXT}"))


def manifolds(
    sample: Sample, margin: float, spec: Spec = EVERY_SHAPE, scratch: Any = None
) -> list[poses.Manifold]:
    """Return the manifold of every pose; scratch: in place of a new one."""
    count = len(sample.first)
    found, normals = np.zeros(4 * count, dtype(POINT)), np.full((count, 3), np.nan)
    counts = np.zeros(count, np.int64)
    if scratch is None:
        scratch = allocate_scratch(hull_geometry(sample.hulls))
    kind = SHAPE_PAIRS[sample.pair].kind
    every_pose(spec)(kind, sample.first, sample.second, found, normals, counts, margin, scratch)
    assert counts.max(initial=0) <= 4
    results = []
    for i in range(count):
        rows = found[4 * i : 4 * i + counts[i]]
        places = np.column_stack([rows["x"], rows["y"], rows["z"]])
        results.append(
            poses.Manifold(places, rows["phi"].copy(), rows["feature"].copy(), normals[i])
        )
    return results


def separations(sample: Sample) -> np.ndarray:
    """Return (distance, nx, ny, nz) of every pose."""
    found = np.zeros((len(sample.first), 4))
    scratch = allocate_scratch(hull_geometry(sample.hulls))
    every_separation()(SHAPE_PAIRS[sample.pair].kind, sample.first, sample.second, found, scratch)
    return found


def triangulated(points: np.ndarray) -> tuple[np.ndarray, list]:
    """Return corners about their mean, and the triangles of their hull, turning left outside."""
    found = ConvexHull(points)
    corners = points[found.vertices] - points[found.vertices].mean(axis=0)
    number = {int(old): new for new, old in enumerate(found.vertices)}
    faces = []
    for triangle, equation in zip(found.simplices, found.equations, strict=True):
        p, q, r = points[triangle]
        turned = np.cross(q - p, r - p) @ equation[:3] < 0.0
        faces.append([number[int(k)] for k in (triangle[::-1] if turned else triangle)])
    return corners, faces


def random_hulls(rng: np.random.Generator, count: int = 8) -> list:
    """Return hulls of 4 to 24 points on ellipsoids."""
    hulls = []
    for _ in range(count):
        points = rng.normal(size=(rng.integers(4, 25), 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        hulls.append(triangulated(points * np.exp(rng.uniform(-1.5, 0.0, 3))))
    return hulls


def put(row: np.void, kind: str, half, centre=(0.0, 0.0, 0.0), matrix=None, **properties) -> None:
    """Fill one body record; a capsule and a cylinder take (radius, -, half length)."""
    row["shape"] = solids.KINDS.index(kind)
    row["hx"], row["hy"], row["hz"] = half
    row["offset"] = properties.get("offset", 0.0)
    if kind == "hull":
        row["hull"] = properties.get("hull", 0)
    row["x"], row["y"], row["z"] = centre
    turned = np.eye(3) if matrix is None else matrix
    for i in range(3):
        for j in range(3):
            row[f"r{i}{j}"] = turned[i, j]
    if kind == "hull":
        row["bound"] = np.linalg.norm(properties["corners"], axis=1).max()
    else:
        row["bound"] = {
            "plane": 0.0,
            "bowl": half[0],
            "drum": half[0],
            "sphere": half[0],
            "box": float(np.linalg.norm(half)),
            "capsule": half[0] + half[2],
            "ellipsoid": max(half),
            "cone": max(3.0 * half[2], float(np.hypot(half[0], half[2]))),
            "cylinder": float(np.hypot(half[0], half[2])),
        }[kind]


def random_sample(
    pair: str, count: int, seed: int = 0, sizes=(0.13, 1.0), spread: float = 1.3
) -> Sample:
    """Return random poses, a third with parallel axes; centres within `spread` bounding radii."""
    rng = np.random.default_rng([seed, *pair.encode()])
    hulls = random_hulls(rng)
    kinds = SHAPE_PAIRS[pair].shapes
    first, second = allocate_bodies(EVERY_SHAPE, count), allocate_bodies(EVERY_SHAPE, count)
    for i in range(count):
        matrix = convex.random_rotation(rng)
        for row, kind in ((first[i], kinds[0]), (second[i], kinds[1])):
            if row is not first[i] and i % 3:
                matrix = convex.random_rotation(rng)
            half = np.exp(rng.uniform(*np.log(sizes), 3))
            if kind == "plane":
                half = rng.normal(size=3)
                half /= np.linalg.norm(half)
                put(row, kind, half, offset=rng.normal())
                continue
            hull = int(rng.integers(len(hulls)))
            put(row, kind, half, matrix=matrix, hull=hull, corners=hulls[hull][0])
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        start = rng.normal(size=3)
        if kinds[0] == "plane":
            normal = np.array([first[i][k] for k in ("hx", "hy", "hz")])
            height = first[i]["offset"] + rng.uniform(-0.5, spread) * second[i]["bound"]
            centre = start + (height - start @ normal) * normal
        else:
            first[i]["x"], first[i]["y"], first[i]["z"] = start
            reach = first[i]["bound"] + second[i]["bound"]
            centre = start + direction * rng.uniform(0.0, spread) * reach
        second[i]["x"], second[i]["y"], second[i]["z"] = centre
    return Sample(pair, first, second, hulls)
