"""Two capsules enter; one point leaves, or the two ends of the overlap of parallel ones.

        A  (=====s======)            p + s u and q + r w are the nearest points of the axes;
              |      |               side by side the axes are as near all along their overlap
              (======r=======)  B

    phi = |q + r w - p - s u| - r_a - r_b

Axes that meet have no direction of their own: n is then across both of them.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel
from ..manifold.point import place
from ..shape_pair import ShapePair

# Axes whose directions differ by less than this [rad] touch in two points. The ends of an overlap
# of 2 hz metres are then up to 2e-3 hz beside each other: some 1e-6 hz^2 / r too deep [m].
PARALLEL = 2e-3
# Axes nearer than this share of the capsules' sizes meet: their offset is round-off [-].
MEETING = 1e-14


@inner
def nearest_on_axes(dx, dy, dz, ux, uy, uz, wx, wy, wz, ha, hb):
    """Nearest points of two segments: (s, r), from their centres along the units u and w [m].

    d: from the centre of the first to that of the second; ha, hb: half lengths.
    """
    cosine = ux * wx + uy * wy + uz * wz
    du = dx * ux + dy * uy + dz * uz
    dw = dx * wx + dy * wy + dz * wz
    cx, cy, cz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    squared = cx * cx + cy * cy + cz * cz  # sine squared, exact where the axes are nearly parallel
    s = 0.0
    if squared > 1e-30:
        s = min(max((du - cosine * dw) / squared, -ha), ha)
    # Nearest on B to A's point, then on A to that: exact once either of the two is clamped.
    r = min(max(cosine * s - dw, -hb), hb)
    s = min(max(du + cosine * r, -ha), ha)
    return s, min(max(cosine * s - dw, -hb), hb)


@inner
def direction(dx, dy, dz, a, b):
    """Unit vector along d; across both axes where d is round-off."""
    length = sqrt(dx * dx + dy * dy + dz * dz)
    if length > MEETING * (a.bound + b.bound):
        return dx / length, dy / length, dz / length
    cx = a.r12 * b.r22 - a.r22 * b.r12
    cy = a.r22 * b.r02 - a.r02 * b.r22
    cz = a.r02 * b.r12 - a.r12 * b.r02
    sine = sqrt(cx * cx + cy * cy + cz * cz)
    if sine > PARALLEL:
        # Away from A's centre where the offset says which way that is.
        s = 1.0 if (b.x - a.x) * cx + (b.y - a.y) * cy + (b.z - a.z) * cz >= 0.0 else -1.0
        return s * cx / sine, s * cy / sine, s * cz / sine
    return a.r00, a.r10, a.r20


def make(spec):
    """Return `kernel(a, b, points, normal, scratch, margin) -> count`."""

    def capsule_capsule(a, b, points, normal, scratch, margin):
        dx, dy, dz = b.x - a.x, b.y - a.y, b.z - a.z
        ux, uy, uz, wx, wy, wz = a.r02, a.r12, a.r22, b.r02, b.r12, b.r22
        s, r = nearest_on_axes(dx, dy, dz, ux, uy, uz, wx, wy, wz, a.hz, b.hz)
        ex, ey, ez = dx + r * wx - s * ux, dy + r * wy - s * uy, dz + r * wz - s * uz
        squared = ex * ex + ey * ey + ez * ez
        reach = a.hx + b.hx + margin
        if squared > reach * reach:
            return 0
        nx, ny, nz = direction(ex, ey, ez, a, b)
        normal[0], normal[1], normal[2] = nx, ny, nz
        phi = sqrt(squared) - a.hx - b.hx
        cx, cy, cz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        cosine = ux * wx + uy * wy + uz * wz
        count = 0
        if cx * cx + cy * cy + cz * cz <= PARALLEL * PARALLEL:
            # The overlap, along A's axis; without one the nearest points are two ends.
            centre, half = dx * ux + dy * uy + dz * uz, b.hz * abs(cosine)
            low, high = max(centre - half, -a.hz), min(centre + half, a.hz)
            if high > low:
                for end in range(2):
                    s = high if end else low
                    r = min(max(((s - centre) * cosine), -b.hz), b.hz)
                    ex, ey, ez = dx + r * wx - s * ux, dy + r * wy - s * uy, dz + r * wz - s * uz
                    gap = ex * nx + ey * ny + ez * nz - a.hx - b.hx
                    if gap <= margin:
                        # Half way between the surfaces, and between the axes seen along n.
                        k = 0.5 * (a.hx - b.hx)
                        place(
                            points[count],
                            a.x + s * ux + 0.5 * ex + k * nx,
                            a.y + s * uy + 0.5 * ey + k * ny,
                            a.z + s * uz + 0.5 * ez + k * nz,
                            gap,
                            1 + end,
                        )
                        count += 1
                if count > 0:
                    return count
        middle = a.hx + 0.5 * phi
        place(
            points[0],
            a.x + s * ux + nx * middle,
            a.y + s * uy + ny * middle,
            a.z + s * uz + nz * middle,
            phi,
            0,
        )
        return 1

    return kernel(capsule_capsule, spec)


PAIR = ShapePair("capsule_capsule", ("capsule", "capsule"), make, closed_form=True)
