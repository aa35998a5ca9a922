"""Manifold of a rope: one point while it may be taut in the step, along the line of its two ends.

    phi = L - |d|,   d from A's end to B's;   n = -d/|d|: a push along it draws the ends together
A rope is a pair of rows of the body table that stand for its ends: each follows the body that it is
tied to (`effects.compound`), and touches nothing else. Every point of the line has the same levers;
the point is A's end, which stays where it is on its body.
"""

from __future__ import annotations

from ..compile import kernel
from ..records import ROPE
from ..spec import Spec
from ..vectors import Vec3, length, minus, position, scaled
from .manifold.point import place, put_manifold_normal

# Features of ropes, each with its number; no shape has as many.
FIRST_ROPE = 1 << 48


def make_count_connections(spec: Spec):
    """Return `kernel(pairs) -> how many` rows are of ropes and joints, before all others."""

    def count_connections(pairs):
        count = 0
        while count < pairs.shape[0] and pairs[count].kind <= ROPE:
            count += 1
        return count

    return kernel(count_connections, spec)


def make_rope(spec: Spec):
    """Return `kernel(a, b, margin, scratch) -> count`, which writes `scratch.manifold`.

    a, b: rows of the ends; hx of A's is the rope's length [m], hy its number.
    """

    def rope(a, b, margin, scratch):
        d = minus(position(b), position(a))
        size = length(d)
        phi = a.hx - size
        if phi > margin:
            return 0
        n = scaled(-1.0 / size, d) if size > 0.0 else Vec3(0.0, 0.0, 1.0)
        put_manifold_normal(scratch.manifold, n)
        place(scratch.manifold.points[0], position(a), phi, FIRST_ROPE + int(a.hy))
        return 1

    return kernel(rope, spec)
