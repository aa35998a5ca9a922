"""Depth by which bodies overlap, from logged poses and the shapes of the config alone."""

from __future__ import annotations

import numpy as np

from lavendersim.measures.columns import last_window
from lavendersim.measures.interfaces import Trace
from lavendersim.measures.overlap_of_bodies import overlap_of_rows
from lavendersim.measures.registration import measure
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
