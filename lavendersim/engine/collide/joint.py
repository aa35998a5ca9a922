"""Rows of a joint: one pair each, whose point has the normal of its direction, at every distance.

    phi = n . (x_B - x_A),   n one of the world's axes;   x_A, x_B: where the joint is on each body
The two rows of the body table that stand for its ends follow the bodies that they are of
(`effects.compound`), and touch nothing. Each body gets the impulse at its own end: ends that are
apart by d, within what projection leaves, are turned by the two together by d x p.
"""

from __future__ import annotations

from ..compile import inner, kernel
from ..spec import Spec
from ..vectors import Vec3, dot, minus, plus_scaled, position
from .manifold.point import place, put_manifold_normal
from .rope import ROPE

# `kind` of the pair of a row, by its axis: less than a rope's.
FIRST_AXIS = ROPE - 1
# Features of joints: eight for each, from here on; no shape has as many.
FIRST_JOINT = 1 << 49
ROWS = 8


@inner
def number_of(feature):
    """Return the number of a joint, from 1, by the feature of one of its rows."""
    return (feature - FIRST_JOINT) // ROWS + 1


@inner
def axis_of(kind):
    """Return which axis of the world the row of a pair of this kind is along."""
    return FIRST_AXIS - kind


def make_joint(spec: Spec):
    """Return `kernel(kind, a, b, scratch) -> 1`, which writes `scratch.manifold`.

    a, b: rows of the ends; hy of A's is the joint's number, from 0.
    """

    def joint(kind, a, b, scratch):
        axis = axis_of(kind)
        n = Vec3(1.0 if axis == 0 else 0.0, 1.0 if axis == 1 else 0.0, 1.0 if axis == 2 else 0.0)
        d = minus(position(b), position(a))
        put_manifold_normal(scratch.manifold, n)
        at = plus_scaled(position(a), 0.5, d)
        place(scratch.manifold.points[0], at, dot(n, d), FIRST_JOINT + ROWS * int(a.hy) + axis)
        return 1

    return kernel(joint, spec)
