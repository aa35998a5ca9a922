"""The deepest overlap of any two bodies in states of a log, by poses and shapes alone."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from lavendersim.cell import CellScene
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.minkowski_sums import extents
from lavendersim.geometry.periodic_cell import nearest_images
from lavendersim.geometry.shapes import HalfSpace
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.penetration import DEPTHS, depths
from lavendersim.measures.solids import (
    KINDS,
    OTHER,
    PlacedSolids,
    Solids,
    kind_of,
    near_pairs,
    solids_of,
)

NAN: Final = float("nan")


def unknown_overlap(scene: CellScene) -> str:
    """Return which shapes of a scene have no depth in closed form, in words; empty where all have.

    Two bodies may come close at some time if one of them moves.
    """
    bodies = [body for body in scene.bodies.values() if body.shape.kind != "plane"]
    names = {kind: name for name, kind in KINDS.items()}
    for k, one in enumerate(bodies):
        if (kind := kind_of(one.shape)) == OTHER:
            return f"no closed form for the depth of a {one.shape.kind}"
        for other in bodies[k + 1 :]:
            pair = tuple(sorted((kind, kind_of(other.shape))))
            if OTHER not in pair and pair not in DEPTHS and (is_movable(one) or is_movable(other)):
                return f"no closed form for the depth of {names[pair[0]]} and {names[pair[1]]}"
    return ""


def overlap_of_rows(trace: Trace, rows: Any) -> Floats:
    """Return the deepest penetration [m] of any two bodies in each of these rows of the log.

    In a periodic cell bodies overlap across its faces, too, each with the other's nearest image.
    """
    periodic = trace.config.scene.periodic
    solids, grounds = solids_of(trace.config.scene, list(trace.bodies))
    poses = trace.pose
    deepest = np.zeros(len(rows))
    for index, row in enumerate(rows):
        placed = solids.placed(poses[row])
        found = [
            *_with_planes(solids, placed, grounds),
            *_among_solids(solids, placed, periodic),
        ]
        # np.max, not fmax: one depth that is unknown leaves the deepest unknown
        deepest[index] = max(0.0, np.max(found)) if not np.isnan(found).any() else NAN
    return deepest


def _with_planes(solids: Solids, placed: PlacedSolids, grounds: list[HalfSpace]) -> list[float]:
    found = [0.0]
    for normal, offset in grounds:
        inside = offset - placed.position @ normal + extents(solids.sums, placed.rotation, -normal)
        inside = inside[solids.movable]
        found += [float(np.max(np.where(np.isinf(inside), NAN, inside)))] if len(inside) else []
    return found


def _among_solids(solids: Solids, placed: PlacedSolids, periodic: Any) -> list[float]:
    first, second = near_pairs(solids.sums, placed, solids.movable, periodic)
    found = [0.0]
    kinds = np.stack([solids.kind[first], solids.kind[second]], axis=1)
    for kind_a, kind_b in np.unique(kinds, axis=0):
        alike = (kinds == (kind_a, kind_b)).all(axis=1)
        a, b = placed.take(first[alike]), placed.take(second[alike])
        b = b._replace(position=nearest_images(b.position, a.position, periodic))
        found.append(float(np.max(depths(int(kind_a), int(kind_b), a, b))))
    return found
