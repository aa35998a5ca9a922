"""Swept contacts: fast bodies touch where they meet in the step, found by conservative advancement.

A contact made from the pose at the start of a step has that pose's normal. A body that moves by
more than half its size before the step is over may pass beside what the normal points to (a wall's
edge) and would hit a ghost. For such pairs B is moved along the relative displacement
d = (v_B - v_A) dt to where the surfaces meet, the manifold is taken there, and B is put back:

    f(t) = distance with B at x_B + t d, 0 <= t <= 1; convex where both shapes are, f' = n . d
    t <- t - (f - TOUCHING/2) / (n . d)        Newton's method: from before a root never beyond it

This is conservative advancement (B. Mirtich, 1996) for bodies that do not rotate. Beyond the
nearest approach n . d >= 0: then they do not meet. If they come within the margin the manifold is
taken at the nearest approach, where d is across the normal and the contact stops nothing that moves
as foreseen; else there is none.

The result is a contact of the start of the step: phi = gap there - t n . d, so that with the
velocities as they are phi + v_n t dt is the gap at t. Points are where they are relative to A's
centre at t: A's surface is at p - n phi/2 as ever. Relative to B's centre B's surface is at

    p + n phi/2 - x_B - (s - n (n . s)),       s = (v_B - v_A) time

Rotation is ignored: normal and points are those of the orientations at the start, and surfaces may
be (|omega_A| R_A + |omega_B| R_B) time from where they are thought to be. A margin not less than
that (the sum of two reaches is) keeps every pair that rotation, or the impulse of another contact,
could bring together. Parts move with the velocity of their owner's centre.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile import inner, kernel
from ..effects.fast_bodies import FAST
from ..records import BOWL, DRUM, MESH, PLANE, ROPE_END, TOUCHING
from ..spec import Spec
from ..vectors import Vec3, dot, length, minus, plus_scaled, position
from .convex.separation import make_separation
from .iteration_limits import needs_separation
from .manifold.own_normals import point_normal
from .manifold.point import copy_point, manifold_normal, place, put_manifold_normal
from .pairs.convex import NEAREST
from .records import put_position
from .shape_kernels import make_radius
from .shapes import has_cavity, has_mesh

ANY_MARGIN = 1e100  # [m]
# Newton's steps: a few for an impact; a graze halves what is left in each, and 1e-9 of 1 m is 30.
# Beside a mesh steps of the gap: at an angle a to a face each leaves 1 - sin a of it.
ADVANCES = 64
# Halvings towards the nearest approach, and how nearly across the normal it must be [-].
APPROACHES, ACROSS = 30, 1e-3
# Least cosine between the manifold's normal and that of the distance [-]: 2.6 degrees.
ALIGNED = 0.999


class Impact(NamedTuple):
    """Where two bodies touch first, or are nearest."""

    t: float  # share of the displacement, 0 ... 1
    gap: float  # there [m]; they touch when it is TOUCHING at most
    normal: Vec3  # there


def make_is_apart(spec: Spec):
    """Return `kernel(a, b, d, margin)`: whether no swept contact of these two is within a margin.

    For displacements d of a margin at most, and never with what is not fast, see below.
    """
    has_size = _make_has_size(spec)

    def is_apart(a, b, d, margin):
        way, reach = minus(position(b), position(a)), a.bound + b.bound + 2.0 * margin
        if dot(way, way) > reach * reach and dot(d, d) <= margin * margin:
            return has_size(a) and has_size(b)
        return False

    return kernel(is_apart, spec)


def make_is_fast(spec: Spec):
    """Return `kernel(a, b, d)`: whether the displacement d relative to each other exceeds FAST R.

    Never with a plane: its normal is the same from everywhere; nor in a cavity, whose distance is
    no convex function of the way; nor the ends of ropes and joints.
    """
    has_size = _make_has_size(spec)

    def is_fast(a, b, d):
        if not (has_size(a) and has_size(b)):
            return False
        far = FAST * min(a.bound, b.bound)
        return dot(d, d) > far * far

    return kernel(is_fast, spec)


def _make_has_size(spec: Spec):
    ends, cavities = spec.connects, has_cavity(spec)

    def has_size(body):
        if cavities:
            if body.shape == BOWL or body.shape == DRUM:
                return False
        if ends:
            if body.shape == ROPE_END:
                return False
        return body.shape != PLANE

    return kernel(has_size, spec)


@inner
def between_cores(a, found, grown, n):
    """Return the point half way between two surfaces; grown: the radius of A's less that of B's."""
    return Vec3(
        a.x + 0.5 * (found.ax + found.bx + grown * n.x),
        a.y + 0.5 * (found.ay + found.by + grown * n.y),
        a.z + 0.5 * (found.az + found.bz + grown * n.z),
    )


def make_gap(spec: Spec, manifold):
    """Return `kernel(kind, a, b, scratch) -> (distance, n)`.

    The first point of `scratch.manifold` is then between the witness points, where the two do not
    overlap.
    """
    # The general walk is a second or two of compiling: only where a pair needs it.
    if not needs_separation(spec):

        def closed_gap(kind, a, b, scratch):
            count = manifold(kind, a, b, ANY_MARGIN, scratch)
            points = scratch.manifold.points
            for k in range(1, count):
                if points[k].phi < points[0].phi:
                    copy_point(points[k], points[0])
            return points[0].phi, manifold_normal(scratch.manifold)

        return kernel(closed_gap, spec)
    separation, radius = make_separation(spec), make_radius(spec)

    def general_gap(kind, a, b, scratch):
        gap, n = separation(kind, a, b, scratch)
        middle = between_cores(a, scratch.separation[0], radius(a) - radius(b), n)
        place(scratch.manifold.points[0], middle, gap, NEAREST)
        return gap, n

    return kernel(general_gap, spec)


def make_find_impact(spec: Spec, manifold):
    """Return `kernel(kind, a, b, d, scratch) -> Impact`: move B along d to where it touches A.

    Or to where it is nearest. What is on its way after ADVANCES is counted in
    `scratch.not_converged`; the nearest approach lies within 2^-APPROACHES of what was halved.
    """
    gap_at = make_gap(spec, manifold)

    def find_impact(kind, a, b, d, scratch):
        start = position(b)
        gap, n = gap_at(kind, a, b, scratch)
        closing = -dot(d, n)
        before, t = 0.0, 0.0
        for _ in range(ADVANCES):
            # Written so that a NaN ends it.
            if not (gap > TOUCHING and closing > 0.0 and t < 1.0):
                break
            before, t = t, min(t + (gap - 0.5 * TOUCHING) / closing, 1.0)
            put_position(b, plus_scaled(start, t, d))
            gap, n = gap_at(kind, a, b, scratch)
            closing = -dot(d, n)
        else:
            if gap > TOUCHING and closing > 0.0 and t < 1.0:
                scratch.not_converged[0].advance += 1
        if gap > TOUCHING and closing < 0.0 and t > 0.0:
            # They closed before and part now: halve what lies between.
            slow = ACROSS * ACROSS * dot(d, d)
            after = t
            for _ in range(APPROACHES):
                if closing <= 0.0:
                    after = t
                    if closing * closing <= slow:
                        break
                else:
                    before = t
                t = 0.5 * (before + after)
                put_position(b, plus_scaled(start, t, d))
                gap, n = gap_at(kind, a, b, scratch)
                closing = -dot(d, n)
        return Impact(t, gap, n)

    return kernel(find_impact, spec)


@inner
def move_to_start(point, impact, n, along):
    """Make a point of the manifold at the impact one of the start of the step.

    along: n . d, with n the normal of the manifold.
    """
    phi = point.phi + max(-impact.t * along, 0.0)
    if impact.gap > TOUCHING:  # what passes is not to be stopped, were the normal a little askew
        phi = max(phi, TOUCHING - along)
    place(point, plus_scaled(point, 0.5 * (phi - point.phi), n), phi, point.feature)


def make_swept_mesh(spec: Spec, manifold: Any) -> Any:
    """Return `kernel(kind, a, b, d, margin, scratch) -> (count, t)`, see `make_swept_manifold`.

    The distance to a mesh is no convex function of the way, but it changes by no more than the way:
    t <- t + gap/|d|. Each point has its own normal. What meets nothing has the points of its start.
    """
    if not has_mesh(spec):
        return None

    def swept_mesh(kind, a, b, d, margin, scratch):
        points, start, far = scratch.manifold.points, position(b), length(d)
        t, gap = 0.0, 0.0
        for _ in range(ADVANCES):
            found = manifold(kind, a, b, (1.0 - t) * far + TOUCHING, scratch)
            gap = ANY_MARGIN
            for k in range(found):
                gap = min(gap, points[k].phi)
            # Written so that a NaN ends it.
            if not (gap > TOUCHING and gap < ANY_MARGIN and t < 1.0):
                break
            t = min(t + (gap - 0.5 * TOUCHING) / far, 1.0)
            put_position(b, plus_scaled(start, t, d))
        else:
            scratch.not_converged[0].advance += 1
        if not gap <= TOUCHING:
            t = 0.0
            put_position(b, start)
        count = manifold(kind, a, b, margin, scratch)
        put_position(b, start)
        if t > 0.0:
            for k in range(count):
                n = point_normal(scratch.manifold, k)
                phi = points[k].phi + max(-t * dot(d, n), 0.0)
                middle = plus_scaled(points[k], 0.5 * (phi - points[k].phi), n)
                place(points[k], middle, phi, points[k].feature)
        return count, t

    return kernel(swept_mesh, spec)


def make_swept_manifold(spec: Spec, manifold):
    """Return `kernel(kind, a, b, d, margin, scratch) -> (count, t)`.

    manifold: `narrow_phase.make_manifold(spec, spec.shape_pairs)`. d: displacement of B relative to
    A in the step [m]; t: the share of it up to the impact, 0 for bodies that touch already. margin:
    TOUCHING at least, see above. The rows of a and b are left as they were.
    """
    find_impact, gap_at = make_find_impact(spec, manifold), make_gap(spec, manifold)
    meshes, swept_mesh = has_mesh(spec), make_swept_mesh(spec, manifold)

    def swept_manifold(kind, a, b, d, margin, scratch):
        if meshes:
            if a.shape == MESH:
                return swept_mesh(kind, a, b, d, margin, scratch)
        points, normal = scratch.manifold.points, scratch.manifold.normal
        start = position(b)
        impact = find_impact(kind, a, b, d, scratch)
        t, n = impact.t, impact.normal
        count = 0
        if impact.gap <= margin:
            count = manifold(kind, a, b, margin, scratch)
            if t > 0.0 and dot(n, n) > 0.5:
                cosine = n.x * normal[0] + n.y * normal[1] + n.z * normal[2]
                if count == 0 or cosine < ALIGNED:
                    # Edge by edge the manifold may prefer a face, which d leads along or into, and
                    # find nothing on it. How they meet or pass the distance tells.
                    gap_at(kind, a, b, scratch)
                    put_manifold_normal(scratch.manifold, n)
                    count = 1
        put_position(b, start)
        if count == 0 or t == 0.0:
            return count, 0.0
        n = manifold_normal(scratch.manifold)
        along = dot(d, n)
        for k in range(count):
            move_to_start(points[k], impact, n, along)
        return count, t

    return kernel(swept_manifold, spec)
