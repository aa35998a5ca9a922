"""Manifold of a cavity A and a box B: all of its eight corners that are near the wall.

The feature of a point is its corner, bit 0, 1, 2 set where the corner lies at +x, +y, +z.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...vectors import from_body, plus, position
from ..manifold.cavity_points import CorePoint, make_put_point
from ..shapes.box import corner_of


@once
def make(spec):
    """Return `kernel(cavity, box, margin, scratch) -> count`, which writes `scratch.manifold`."""
    put_point = make_put_point(spec)

    def box_cavity(cavity, box, margin, scratch):
        count = 0
        for corner in range(8):
            p = plus(position(box), from_body(box, corner_of(box, corner)))
            core = CorePoint(p, 0.0, corner)
            count = put_point(cavity, core, margin, scratch.manifold, count)
        return count

    return kernel(box_cavity, spec)
