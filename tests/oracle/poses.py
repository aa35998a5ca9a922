"""Manifolds at many poses of two shapes, by one numba loop per shape pair."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.compile import kernel
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import POINT, TOUCHING, dtype
from lavendersim.engine.spec import Spec

# Kept on disk like the engine's own kernels; the name follows this file's text.
_TEXT = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()[:8]


class Manifold(NamedTuple):
    """Points (n, 3), separations (n,), features (n,) and the normal of one pose."""

    points: np.ndarray
    phi: np.ndarray
    feature: np.ndarray
    normal: np.ndarray


@cache
def _every_pose(pair: str) -> Any:
    def compose(spec: Spec) -> Any:
        manifold = SHAPE_PAIRS[pair].make(spec)

        def every_pose(first, second, found, normals, counts, scratch):
            for i in range(first.shape[0]):
                count = manifold(first[i], second[i], TOUCHING, scratch)
                counts[i] = count
                for k in range(3):
                    normals[i, k] = scratch.manifold.normal[k]
                for k in range(count):
                    row, point = found[4 * i + k], scratch.manifold.points[k]
                    row.x, row.y, row.z = point.x, point.y, point.z
                    row.phi, row.feature = point.phi, point.feature

        return kernel(every_pose, spec)

    return cached(
        compose, Spec(effects=("rotation",), shape_pairs=(pair,), solver=f"poses {_TEXT}")
    )


def allocate(count: int) -> np.ndarray:
    """Return `count` body records with an orientation."""
    return allocate_bodies(Spec(effects=("rotation",), shape_pairs=("box_box",)), count)


def put(row: np.void, half, centre=(0.0, 0.0, 0.0), matrix=None, offset: float = 0.0) -> None:
    """Fill one body record: `half` is half edges, (radius,) or a plane's normal."""
    for name, value in zip(("hx", "hy", "hz"), half, strict=False):
        row[name] = value
    row["bound"] = float(np.linalg.norm(half))
    row["x"], row["y"], row["z"] = centre
    row["offset"] = offset
    turned = np.eye(3) if matrix is None else matrix
    for i in range(3):
        for j in range(3):
            row[f"r{i}{j}"] = turned[i, j]


def manifolds(pair: str, first: np.ndarray, second: np.ndarray) -> list[Manifold]:
    """Return the manifold of every row of `first` with the same row of `second`."""
    count = len(first)
    found, normals = np.zeros(4 * count, dtype(POINT)), np.full((count, 3), np.nan)
    counts = np.zeros(count, np.int64)
    scratch = allocate_scratch()
    _every_pose(pair)(first, second, found, normals, counts, scratch)
    assert counts.max(initial=0) <= 4
    results = []
    for i in range(count):
        rows = found[4 * i : 4 * i + counts[i]]
        places = np.column_stack([rows["x"], rows["y"], rows["z"]])
        results.append(Manifold(places, rows["phi"].copy(), rows["feature"].copy(), normals[i]))
    return results
