"""Manifold of two capsules: one point, or the two ends of the overlap of parallel ones.

        A  (=====s======)            p + s u and q + r w are the nearest points of the axes;
              |      |               side by side the axes are as near all along their overlap
              (======r=======)  B

    phi = |q + r w - p - s u| - r_a - r_b

Axes that meet have no direction of their own: n is then across both of them.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ...vectors import Vec3, cross, divided, dot, length, minus
from ..manifold.point import place, put_manifold_normal

# Axes whose directions differ by less than this [rad] touch in two points. The ends of an overlap
# of 2 hz metres are then up to 2e-3 hz beside each other: some 1e-6 hz^2 / r too deep [m].
PARALLEL = 2e-3
# Axes nearer than this share of the capsules' sizes meet: their offset is round-off [-].
MEETING = 1e-14
# Squared sine [-] below which axes are parallel to the last digit: any point of one is as near.
NO_SINE_SQUARED = 1e-30


@inner
def axis_of(capsule):
    """Return the unit vector along the capsule."""
    return Vec3(capsule.r02, capsule.r12, capsule.r22)


@inner
def nearest_on_axes(d, u, w, half_a, half_b):
    """Nearest points of two segments: (s, r), from their centres along the units u and w [m].

    d: from the centre of the first to that of the second; half_a, half_b: half lengths.
    """
    cosine, du, dw = dot(u, w), dot(d, u), dot(d, w)
    c = cross(u, w)
    squared = dot(c, c)  # sine squared, exact where the axes are nearly parallel
    s = 0.0
    if squared > NO_SINE_SQUARED:
        s = min(max((du - cosine * dw) / squared, -half_a), half_a)
    # Nearest on B to A's point, then on A to that: exact once either of the two is clamped.
    r = min(max(cosine * s - dw, -half_b), half_b)
    s = min(max(du + cosine * r, -half_a), half_a)
    return s, min(max(cosine * s - dw, -half_b), half_b)


@inner
def between(d, r, w, s, u):
    """Return d + r w - s u, from A's point to B's."""
    return Vec3(
        d.x + r * w.x - s * u.x,
        d.y + r * w.y - s * u.y,
        d.z + r * w.z - s * u.z,
    )


@inner
def direction(d, a, b):
    """Unit vector along d; across both axes where d is round-off."""
    distance = length(d)
    if distance > MEETING * (a.bound + b.bound):
        return divided(d, distance)
    c = cross(axis_of(a), axis_of(b))
    sine = length(c)
    if sine > PARALLEL:
        # Away from A's centre where the offset says which way that is.
        s = 1.0 if dot(minus(b, a), c) >= 0.0 else -1.0
        return Vec3(s * c.x / sine, s * c.y / sine, s * c.z / sine)
    return Vec3(a.r00, a.r10, a.r20)


@inner
def put_overlap(a, b, n, margin, points):
    """Write the ends of the overlap of parallel capsules; returns how many."""
    d, u, w = minus(b, a), axis_of(a), axis_of(b)
    cosine = dot(u, w)
    # The overlap, along A's axis; without one the nearest points are two ends.
    centre, half = dot(d, u), b.hz * abs(cosine)
    low, high = max(centre - half, -a.hz), min(centre + half, a.hz)
    count = 0
    if high > low:
        for end in range(2):
            s = high if end else low
            r = min(max(((s - centre) * cosine), -b.hz), b.hz)
            e = between(d, r, w, s, u)
            gap = dot(e, n) - a.hx - b.hx
            if gap <= margin:
                # Half way between the surfaces, and between the axes seen along n.
                k = 0.5 * (a.hx - b.hx)
                p = Vec3(
                    a.x + s * u.x + 0.5 * e.x + k * n.x,
                    a.y + s * u.y + 0.5 * e.y + k * n.y,
                    a.z + s * u.z + 0.5 * e.z + k * n.z,
                )
                place(points[count], p, gap, 1 + end)
                count += 1
    return count


def make(spec):
    """Return `kernel(a, b, margin, scratch) -> count`, which writes `scratch.manifold`."""

    def capsule_capsule(a, b, margin, scratch):
        points = scratch.manifold.points
        d, u, w = minus(b, a), axis_of(a), axis_of(b)
        s, r = nearest_on_axes(d, u, w, a.hz, b.hz)
        e = between(d, r, w, s, u)
        squared = dot(e, e)
        reach = a.hx + b.hx + margin
        if squared > reach * reach:
            return 0
        n = direction(e, a, b)
        put_manifold_normal(scratch.manifold, n)
        phi = sqrt(squared) - a.hx - b.hx
        c = cross(u, w)
        if dot(c, c) <= PARALLEL * PARALLEL:
            count = put_overlap(a, b, n, margin, points)
            if count > 0:
                return count
        middle = a.hx + 0.5 * phi
        p = Vec3(
            a.x + s * u.x + n.x * middle,
            a.y + s * u.y + n.y * middle,
            a.z + s * u.z + n.z * middle,
        )
        place(points[0], p, phi, 0)
        return 1

    return kernel(capsule_capsule, spec)
