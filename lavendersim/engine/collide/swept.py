"""Two bodies and their velocities enter; the manifold of their meeting within the step leaves.

A contact made from the pose at the start of a step has that pose's normal. A body that moves by
more than half its size before the step is over may pass beside what the normal points to (a wall's
edge) and would hit a ghost. For such pairs B is moved along the relative way d = (v_B - v_A) dt to
where the surfaces meet, the manifold is taken there, and B is put back:

    f(t) = distance with B at x_B + t d, 0 <= t <= 1; convex where both shapes are, f' = n . d
    t <- t - (f - TOUCHING/2) / (n . d)        Newton's method: from before a root never beyond it

Beyond the nearest approach n . d >= 0: then they do not meet. If they come within the margin the
manifold is taken at the nearest approach, where the way is across the normal and the contact stops
nothing that moves as foreseen; else there is none.

What leaves is a contact of the start of the step: phi = gap there - t n . d, so that with the
velocities as they are phi + v_n t dt is the gap at t. Points are where they are relative to A's
centre at t: A's surface is at p - n phi/2 as ever. Relative to B's centre B's surface is at

    p + n phi/2 - x_B - (s - n (n . s)),       s = (v_B - v_A) time

Rotation is ignored: normal and points are those of the orientations at the start, and surfaces may
be (|omega_A| R_A + |omega_B| R_B) time from where they are thought to be. A margin not less than
that (the sum of two reaches is) keeps every pair that rotation, or the impulse of another contact,
could bring together. Parts move with the velocity of their owner's centre.
"""

from __future__ import annotations

from ..compile import kernel
from ..effects.fast_bodies import FAST
from ..records import PLANE, TOUCHING
from ..spec import Spec
from . import SHAPE_PAIRS
from .convex.separation import make_separation
from .convex.support import make_radius
from .manifold.point import copy_point, place
from .pairs.convex import NEAREST

ANY_MARGIN = 1e100  # [m]
# Newton's steps: a few for an impact; a graze halves the way left in each, and 1e-9 of 1 m is 30.
ADVANCES = 64
# Halvings on the way to the nearest approach, and how nearly across the normal it must be [-].
APPROACHES, ACROSS = 30, 1e-3
# Least cosine between the manifold's normal and that of the distance [-]: 2.6 degrees.
ALIKE = 0.999


def make_is_fast(spec: Spec):
    """Return `kernel(a, b, dx, dy, dz)`: whether the way relative to each other exceeds FAST R.

    Never with a plane: its normal is the same from everywhere.
    """

    def is_fast(a, b, dx, dy, dz):
        if a.shape == PLANE or b.shape == PLANE:
            return False
        far = FAST * min(a.bound, b.bound)
        return dx * dx + dy * dy + dz * dz > far * far

    return kernel(is_fast, spec)


def make_gap(spec: Spec, manifold):
    """Return `kernel(kind, a, b, points, normal, scratch) -> (distance, nx, ny, nz)`.

    points[0] is then the middle of the nearest points, where the two do not overlap.
    """
    # The general walk is a second or two of compiling: only where a pair needs it.
    pairs = [SHAPE_PAIRS[name] for name in spec.shape_pairs]
    if all(pair.closed_form or "plane" in pair.shapes for pair in pairs):

        def closed_gap(kind, a, b, points, normal, scratch):
            count = manifold(kind, a, b, points, normal, scratch, ANY_MARGIN)
            for k in range(1, count):
                if points[k].phi < points[0].phi:
                    copy_point(points[k], points[0])
            return points[0].phi, normal[0], normal[1], normal[2]

        return kernel(closed_gap, spec)
    separation, radius = make_separation(spec), make_radius(spec)

    def general_gap(kind, a, b, points, normal, scratch):
        gap, nx, ny, nz = separation(kind, a, b, scratch)
        core, grown = scratch.result, radius(a) - radius(b)
        place(
            points[0],
            a.x + 0.5 * (core[4] + core[7] + grown * nx),
            a.y + 0.5 * (core[5] + core[8] + grown * ny),
            a.z + 0.5 * (core[6] + core[9] + grown * nz),
            gap,
            NEAREST,
        )
        return gap, nx, ny, nz

    return kernel(general_gap, spec)


def make_meeting(spec: Spec, manifold):
    """Return `kernel(kind, a, b, dx, dy, dz, points, normal, scratch) -> (t, gap, nx, ny, nz)`.

    Moves B to where it first touches A, or is nearest; t in 0 ... 1 of the way d. They touch there
    when gap <= TOUCHING.
    """
    gap_at = make_gap(spec, manifold)

    def meeting(kind, a, b, dx, dy, dz, points, normal, scratch):
        x, y, z = b.x, b.y, b.z
        gap, nx, ny, nz = gap_at(kind, a, b, points, normal, scratch)
        closing = -(dx * nx + dy * ny + dz * nz)
        before, t = 0.0, 0.0
        for _ in range(ADVANCES):
            # Asked so that numbers that are none end it.
            if not (gap > TOUCHING and closing > 0.0 and t < 1.0):
                break
            before, t = t, min(t + (gap - 0.5 * TOUCHING) / closing, 1.0)
            b.x, b.y, b.z = x + t * dx, y + t * dy, z + t * dz
            gap, nx, ny, nz = gap_at(kind, a, b, points, normal, scratch)
            closing = -(dx * nx + dy * ny + dz * nz)
        if gap > TOUCHING and closing < 0.0 and t > 0.0:
            # They closed before and part now: halve what lies between.
            slow = ACROSS * ACROSS * (dx * dx + dy * dy + dz * dz)
            after = t
            for _ in range(APPROACHES):
                if closing <= 0.0:
                    after = t
                    if closing * closing <= slow:
                        break
                else:
                    before = t
                t = 0.5 * (before + after)
                b.x, b.y, b.z = x + t * dx, y + t * dy, z + t * dz
                gap, nx, ny, nz = gap_at(kind, a, b, points, normal, scratch)
                closing = -(dx * nx + dy * ny + dz * nz)
        return t, gap, nx, ny, nz

    return kernel(meeting, spec)


def make_swept_manifold(spec: Spec, manifold):
    """Return `kernel(kind, a, b, dx, dy, dz, points, normal, scratch, margin) -> (count, t)`.

    manifold: `narrow_phase.make_manifold(spec, spec.shape_pairs)`. d: way of B relative to A in the
    step [m]; t: share of it up to the meeting, 0 for bodies that touch already. margin: TOUCHING at
    least, see above. The rows of a and b are left as they were.
    """
    meeting, gap_at = make_meeting(spec, manifold), make_gap(spec, manifold)

    def swept_manifold(kind, a, b, dx, dy, dz, points, normal, scratch, margin):
        x, y, z = b.x, b.y, b.z
        t, gap, nx, ny, nz = meeting(kind, a, b, dx, dy, dz, points, normal, scratch)
        count = 0
        if gap <= margin:
            count = manifold(kind, a, b, points, normal, scratch, margin)
            if t > 0.0 and nx * nx + ny * ny + nz * nz > 0.5:
                alike = nx * normal[0] + ny * normal[1] + nz * normal[2]
                if count == 0 or alike < ALIKE:
                    # Edge by edge the manifold may prefer a face, which the way leads along or
                    # into, and find nothing on it. How they meet or pass the distance tells.
                    gap_at(kind, a, b, points, normal, scratch)
                    normal[0], normal[1], normal[2] = nx, ny, nz
                    count = 1
        b.x, b.y, b.z = x, y, z
        if count == 0 or t == 0.0:
            return count, 0.0
        along = dx * normal[0] + dy * normal[1] + dz * normal[2]
        way = max(-t * along, 0.0)
        for k in range(count):
            point = points[k]
            phi = point.phi + way
            if gap > TOUCHING:  # what passes is not to be stopped, were the normal a little askew
                phi = max(phi, TOUCHING - along)
            half = 0.5 * (phi - point.phi)
            place(
                point,
                point.x + half * normal[0],
                point.y + half * normal[1],
                point.z + half * normal[2],
                phi,
                point.feature,
            )
        return count, t

    return kernel(swept_manifold, spec)
