"""Rows of a joint: one pair each, whose point has the normal of its direction, at every distance.

    phi = n . (x_B - x_A),   n an axis of the world or of A's end;   x_A, x_B: its ends on each body
The two rows of the body table that stand for the ends of a point follow the bodies that they are of
(`effects.compound`), and touch nothing. Each body gets the impulse at its own end: ends that are
apart by d, within what projection leaves, are turned by the two together by d x p. So are rows of
one joint alike about their axis, whatever d: in a linkage of parallel hinges, which has rows too
many, they never contradict each other. Ends that slide are apart; both get the impulse at B's:
    dphi/dt = n . (v_B + w_B x r_B - v_A - w_A x (r_A + d)),    n turns with A
"""

from __future__ import annotations

from ..compile import inner, kernel
from ..spec import Spec
from ..vectors import Vec3, dot, minus, plus_scaled, position
from .manifold.point import place, put_manifold_normal
from .records import put_arms
from .rope import ROPE

# `kind` of the pair of a row, less than a rope's: FIRST_ROW - (DIRECTIONS * which row + direction).
FIRST_ROW = ROPE - 1
# Directions of rows: x y z of the world, x y z of A's end, and of ends that slide along z x y.
DIRECTIONS, WITH_A, SLIDING = 8, 3, 6
# Features of joints: eight for each, from here on; no shape has as many.
FIRST_JOINT = 1 << 49
ROWS = 8


@inner
def number_of(feature):
    """Return the number of a joint, from 1, by the feature of one of its rows."""
    return (feature - FIRST_JOINT) // ROWS + 1


@inner
def direction_of(kind):
    """Return the direction of the row of a pair of this kind, by its number."""
    return (FIRST_ROW - kind) % DIRECTIONS


@inner
def is_sliding(kind):
    """Whether the ends of a pair of this kind slide, across the direction of its row."""
    return direction_of(kind) >= SLIDING


@inner
def free_along(kind, end):
    """Return the unit vector along which the ends of a pair of this kind slide, or 0; end: of A."""
    if is_sliding(kind):
        return Vec3(end.r02, end.r12, end.r22)
    return Vec3(0.0, 0.0, 0.0)


@inner
def _direction(kind, end):
    """Return the unit vector of the row of a pair of this kind; end: of A."""
    which = direction_of(kind)
    if which >= WITH_A:
        axis = which - (SLIDING if which >= SLIDING else WITH_A)
        if axis == 0:
            return Vec3(end.r00, end.r10, end.r20)
        if axis == 1:
            return Vec3(end.r01, end.r11, end.r21)
        return Vec3(end.r02, end.r12, end.r22)
    return Vec3(1.0 if which == 0 else 0.0, 1.0 if which == 1 else 0.0, 1.0 if which == 2 else 0.0)


@inner
def put_ends(contact, kind, end_a, end_b, a, b):
    """Fill what a row of a joint has of its ends, where these are; a, b: the bodies themselves."""
    at_a, at_b = position(end_a), position(end_b)
    contact.sliding = 0
    if is_sliding(kind):
        at_a, contact.sliding = at_b, 1
    put_arms(contact, minus(at_a, position(a)), minus(at_b, position(b)))
    free = free_along(kind, end_a)
    contact.free_x, contact.free_y, contact.free_z = free.x, free.y, free.z


def make_joint(spec: Spec):
    """Return `kernel(kind, a, b, scratch) -> 1`, which writes `scratch.manifold`.

    a, b: rows of the ends of a point; hy of A's is the joint's number, from 0.
    """

    def joint(kind, a, b, scratch):
        n = _direction(kind, a)
        d = minus(position(b), position(a))
        put_manifold_normal(scratch.manifold, n)
        at = plus_scaled(position(a), 0.5, d)
        if is_sliding(kind):
            at = position(b)
        row = (FIRST_ROW - kind) // DIRECTIONS
        place(scratch.manifold.points[0], at, dot(n, d), FIRST_JOINT + ROWS * int(a.hy) + row)
        return 1

    return kernel(joint, spec)
