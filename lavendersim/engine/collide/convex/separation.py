"""Signed separation, normal and witness points of two convex bodies, by GJK, EPA and their faces.

    s(n) = min over B of n . x - max over A of n . x,      separation = max over unit n of s(n)

is the distance when they are apart (GJK) and minus the depth when they overlap (EPA). Where a core
is round, EPA's result is improved by `ascend`; last, the normal of a face that separates no less is
taken instead of the one found, so that resting faces have their exact normal.

`scratch.separation` holds the result. Its witness points lie on the cores; a capsule's or sphere's
radius is the caller's to add.
"""

from __future__ import annotations

from ...compile import kernel, once
from ...records import PLANE
from ...vectors import Vec3, dot, minus, negative, plus_scaled, position, scaled
from ..records import UNBOUNDED, copy_separation, normal_of, put_normal
from ..shape_kernels import make_best_face, make_is_curved, make_radius, make_support
from ..shapes import has_curved, shapes_in
from .epa import make_epa
from .gjk import FARTHER, OVERLAPPING, make_gjk

# A face may separate less than the normal found by this share of the shapes' sizes [-].
FACE_SHARE = 1e-10
# Rounds of `ascend`. With the depth d and the radius of curvature r of A - B a round leaves a share
# of some 1.25 d / (r + d / 4) of the error: two or three rounds but for the deepest overlaps.
ASCENTS = 30
# How far B is moved clear of A, as a share of the sizes [-]. Larger: slower; smaller: round-off of
# 1e-16 of the sizes shows in the normal.
CLEARANCE = 1e-4
# And as a multiple of the depth found so far, which may be less than the depth along n [-].
CLEAR = 1.25
# Ascent ends when the normal's components change by less in all, or the separation, as a share of
# the sizes: round-off [-].
STEADY = 1e-6
NO_GAIN = 1e-15


@once
def make_separation_along(spec):
    """Return `kernel(a, b, offset, n, hulls) -> s(n)` of the cores [m]."""
    support = make_support(spec)

    def separation_along(a, b, offset, n, hulls):
        p, q = support(a, n, hulls), support(b, negative(n), hulls)
        gap = Vec3(offset.x + q.x - p.x, offset.y + q.y - p.y, offset.z + q.z - p.z)
        return dot(n, gap)

    return kernel(separation_along, spec)


@once
def make_ascend(spec):
    """Return `kernel(a, b, offset, scratch)`: improve the normal of overlapping cores.

    B is moved out along n until it is clear of A; the normal m of the distance there has
    s(m) + t n . m >= s(n) + t, hence s(m) >= s(n): each round separates more, and stops at a
    direction that no other near it beats. One that still gains after ASCENTS is counted in
    `scratch.not_converged`.
    """
    gjk, separation_along = make_gjk(spec), make_separation_along(spec)

    def ascend(a, b, offset, scratch):
        found, best = scratch.separation[0], scratch.best[0]
        size = a.bound + b.bound
        copy_separation(found, best)
        for _ in range(ASCENTS):
            n = normal_of(best)
            t = CLEAR * max(-best.distance, 0.0) + CLEARANCE * size
            status, _ = gjk(a, b, plus_scaled(offset, t, n), UNBOUNDED, scratch)
            if status == OVERLAPPING:
                break
            m = normal_of(found)
            s = separation_along(a, b, offset, m, scratch.hulls)
            if s < best.distance:
                break
            found.bx -= t * n.x
            found.by -= t * n.y
            found.bz -= t * n.z
            moved = abs(m.x - n.x) + abs(m.y - n.y) + abs(m.z - n.z)
            gain = s - best.distance
            found.distance = s
            copy_separation(found, best)
            if moved < STEADY or gain <= NO_GAIN * size:
                break
        else:
            scratch.not_converged[0].ascent += 1
        copy_separation(best, found)

    return kernel(ascend, spec)


@once
def make_separate(spec):
    """Return `kernel(a, b, offset, reach, scratch) -> apart by no more than reach`.

    Cores only, `reach` [m] as well. When it returns True `scratch.separation` is filled.
    """
    gjk, epa, ascend = make_gjk(spec), make_epa(spec), make_ascend(spec)
    best_face, separation_along = make_best_face(spec), make_separation_along(spec)
    round_cores, is_curved = has_curved(spec), make_is_curved(spec)

    def separate(a, b, offset, reach, scratch):
        status, count = gjk(a, b, offset, reach, scratch)
        if status == FARTHER:
            return False
        if status == OVERLAPPING:
            curved = False
            if round_cores:
                curved = is_curved(a) or is_curved(b)
            epa(a, b, offset, count, curved, scratch)
            if round_cores:
                if curved:
                    ascend(a, b, offset, scratch)
        found = scratch.separation[0]
        if found.distance > reach:
            return False
        least = found.distance - FACE_SHARE * (a.bound + b.bound)
        for which in range(2):
            sign = -1.0 if which else 1.0
            outward = scaled(sign, normal_of(found))
            face, normal = best_face(b if which else a, outward, scratch.hulls)
            if face >= 0:
                n = scaled(sign, normal)
                s = separation_along(a, b, offset, n, scratch.hulls)
                # B's face must be better than A's by more than round-off, or they would alternate.
                if s > least:
                    put_normal(found, n)
                    found.distance = s
                    least = s + FACE_SHARE * (a.bound + b.bound)
        return True

    return kernel(separate, spec)


def make_separation(spec):
    """Return `kernel(kind, a, b, scratch) -> (distance, n)` for any pair of `spec`.

    The true distance between the surfaces and the unit normal from A to B. Where the cores overlap
    (or touch) the distance is minus the radii that the cores are grown by and the normal zero.
    """
    gjk, support, radius = make_gjk(spec), make_support(spec), make_radius(spec)
    planes = any(shape.kind == PLANE for shape in shapes_in(spec))

    def separation(kind, a, b, scratch):
        if planes:
            if a.shape == PLANE:
                n = Vec3(a.hx, a.hy, a.hz)
                p = support(b, negative(n), scratch.hulls)
                height = dot(n, Vec3(b.x + p.x, b.y + p.y, b.z + p.z))
                return height - a.offset - radius(b), n
        status, _ = gjk(a, b, minus(position(b), position(a)), UNBOUNDED, scratch)
        reach = radius(a) + radius(b)
        if status == OVERLAPPING:
            return -reach, Vec3(0.0, 0.0, 0.0)
        found = scratch.separation[0]
        return found.distance - reach, normal_of(found)

    return kernel(separation, spec)
