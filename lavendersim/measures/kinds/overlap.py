"""Depth by which bodies overlap, from logged poses and the shapes of the config alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from lavendersim.geometry.minkowski_sums import extents
from lavendersim.geometry.shapes import HalfSpace
from lavendersim.measures.columns import last_window
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.penetration import depths
from lavendersim.measures.registration import measure
from lavendersim.measures.solids import PlacedSolids, Solids, near_pairs, solids_of
from lavendersim.measures.specs.overlap import Overlap

NAN = float("nan")


@measure(Overlap)
def overlap(spec: Overlap, trace: Trace) -> float:
    """Return the deepest penetration [m] in the last window; 0 when nothing overlaps.

    NaN where the run is shorter than the window, or two bodies come close whose shapes have no
    closed form here (all pairs of spheres, boxes and planes have one, and capsules among
    themselves, with spheres and planes; cylinders with planes only).
    """
    rows = np.flatnonzero(last_window(trace, spec.last))[:: -spec.every]
    return float(np.max(overlap_of_rows(trace, rows))) if len(rows) else NAN


def overlap_of_rows(trace: Trace, rows: Any) -> Floats:
    """Return the deepest penetration [m] of any two bodies in each of these rows of the log."""
    solids, grounds = solids_of(trace.config.scene, list(trace.bodies))
    poses = trace.pose
    deepest = np.zeros(len(rows))
    for index, row in enumerate(rows):
        placed = solids.placed(poses[row])
        found = [
            *_with_planes(solids, placed, grounds),
            *_among_solids(solids, placed),
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


def _among_solids(solids: Solids, placed: PlacedSolids) -> list[float]:
    first, second = near_pairs(solids.sums, placed, solids.movable)
    found = [0.0]
    kinds = np.stack([solids.kind[first], solids.kind[second]], axis=1)
    for kind_a, kind_b in np.unique(kinds, axis=0):
        alike = (kinds == (kind_a, kind_b)).all(axis=1)
        a, b = placed.take(first[alike]), placed.take(second[alike])
        found.append(float(np.max(depths(int(kind_a), int(kind_b), a, b))))
    return found
