"""Rows of a joint: one pair each, whose point has the normal of its direction, at every distance.

    phi = n . (x_B - x_A),   n an axis of the world or of A's end;   x_A, x_B: its ends on each body
The two rows of the body table that stand for the ends of a point follow the bodies that they are of
(`effects.compound`), and touch nothing. Each body gets the impulse at its own end: ends that are
apart by d, within what projection leaves, are turned by the two together by d x p. So are rows of
one joint alike about their axis, whatever d: in a linkage of parallel hinges, which has rows too
many, they never contradict each other. Ends that slide are apart; both get the impulse at B's:
    dphi/dt = n . (v_B + w_B x r_B - v_A - w_A x (r_A + d)),    n turns with A
So do those of stops (`effects.joint_stop`), which are there only near their limit, and of motors.
A motor that turns has no n, and the axis times 1 m for both levers.
"""

from __future__ import annotations

from math import atan2, cos, sin, sqrt
from typing import Any

from ..compile import inner, kernel
from ..records import ROPE
from ..row_terms import row_terms
from ..spec import Spec
from ..vectors import Vec3, dot, minus, plus, plus_scaled, position, scaled
from .manifold.point import place, put_manifold_normal
from .records import put_arms

# `kind` of the pair of a row, less than a rope's: FIRST_ROW - (DIRECTIONS * which row + direction).
FIRST_ROW = ROPE - 1
# Directions of rows: x y z of the world, x y z of A's end, and of ends that slide along z x y.
DIRECTIONS, WITH_A, SLIDING = 16, 3, 6
# Of what moves about, or along, z of A's end: the motor, and from the next on the stops.
ABOUT, ALONG = 8, 11
LOWER, UPPER = 1, 2
# Features of joints: eight for each, from here on. Those of surfaces may be as large.
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
def is_motor(kind):
    """Whether a pair of this kind is of a motor."""
    which = direction_of(kind)
    return which in (ABOUT, ALONG)


@inner
def is_couple(kind):
    """Whether a pair of this kind is of a motor that turns."""
    return direction_of(kind) == ABOUT


@inner
def is_stop(kind):
    """Whether a pair of this kind is of a stop."""
    return direction_of(kind) > ABOUT and not is_motor(kind)


@inner
def is_sliding(kind):
    """Whether the ends of a pair of this kind slide, across the direction of its row."""
    return direction_of(kind) >= SLIDING


@inner
def _axis(end):
    """Return the axis of a joint, z of its end on A."""
    return Vec3(end.r02, end.r12, end.r22)


@inner
def couple_of(end):
    """Return the lever of a motor that turns: its axis, 1 m long; end: of A."""
    return _axis(end)


@inner
def free_along(kind, end):
    """Return the unit vector along which the ends of a pair of this kind slide, or 0; end: of A."""
    if is_sliding(kind):
        return _axis(end)
    return Vec3(0.0, 0.0, 0.0)


@inner
def direction(kind, end):
    """Return the unit vector of the row of a pair of this kind; end: of A."""
    which = direction_of(kind)
    if which >= WITH_A:
        axis = which - (SLIDING if which >= SLIDING else WITH_A)
        if which >= ABOUT:
            axis = 2
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
    apart = minus(at_b, at_a)
    contact.apart_x, contact.apart_y, contact.apart_z = apart.x, apart.y, apart.z
    if is_sliding(kind):
        at_a, contact.sliding = at_b, 1
    if is_couple(kind):
        put_arms(contact, couple_of(end_a), couple_of(end_a))
    else:
        put_arms(contact, minus(at_a, position(a)), minus(at_b, position(b)))
    free = free_along(kind, end_a)
    contact.free_x, contact.free_y, contact.free_z = free.x, free.y, free.z


def make_stop(spec: Spec):
    """Return `kernel(kind, a, b, margin, scratch) -> count`, which writes `scratch.manifold`.

    a, b: rows of its ends; hx of A's and of B's are the lower and the upper limit [rad, m].
    """

    def stop(kind, a, b, margin, scratch):
        d, which = minus(position(b), position(a)), direction_of(kind)
        n, size, moved = _axis(a), 1.0, dot(d, _axis(a))
        upper = which - ALONG == UPPER
        if which < ALONG:
            upper = which - ABOUT == UPPER
            one, other = Vec3(a.r00, a.r10, a.r20), Vec3(a.r01, a.r11, a.r21)
            x, y = dot(d, one), dot(d, other)
            size = sqrt(x * x + y * y)
            # From the middle between the limits, so that none of them is beyond half a turn.
            middle = 0.5 * (a.hx + b.hx)
            c, s = cos(middle), sin(middle)
            moved = middle + atan2(y * c - x * s, x * c + y * s)
            if size > 0.0:
                n = plus(scaled(-y / size, one), scaled(x / size, other))
        phi = size * (moved - a.hx)
        if upper:
            n, phi = scaled(-1.0, n), size * (b.hx - moved)
        if phi > margin:
            return 0
        put_manifold_normal(scratch.manifold, n)
        row = (FIRST_ROW - kind) // DIRECTIONS
        place(scratch.manifold.points[0], position(b), phi, FIRST_JOINT + ROWS * int(a.hy) + row)
        return 1

    return kernel(stop, spec)


def make_joint(spec: Spec):
    """Return `kernel(kind, a, b, margin, scratch) -> count`, which writes `scratch.manifold`.

    a, b: rows of the ends of a point; hy of A's is the joint's number, from 0.
    """
    stopped, driven = row_terms(spec).stopped, row_terms(spec).bounded
    stop: Any = make_stop(spec) if stopped else None

    def joint(kind, a, b, margin, scratch):
        if stopped:
            if is_stop(kind):
                return stop(kind, a, b, margin, scratch)
        n = direction(kind, a)
        d = minus(position(b), position(a))
        put_manifold_normal(scratch.manifold, n)
        at = plus_scaled(position(a), 0.5, d)
        if is_sliding(kind):
            at = position(b)
        phi = dot(n, d)
        if driven:
            if is_motor(kind):
                phi = 0.0
                if is_couple(kind):
                    put_manifold_normal(scratch.manifold, Vec3(0.0, 0.0, 0.0))
        row = (FIRST_ROW - kind) // DIRECTIONS
        place(scratch.manifold.points[0], at, phi, FIRST_JOINT + ROWS * int(a.hy) + row)
        return 1

    return kernel(joint, spec)
