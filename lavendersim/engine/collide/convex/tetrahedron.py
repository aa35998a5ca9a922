"""A simplex of differences enters; four corners that span a volume leave, for EPA to start from.

GJK ends with one to four corners of the set M of differences a - b (gjk.py). Whatever of them spans
a line, a plane and a volume is kept; the rest is looked for across what there is.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel, once
from .gjk import make_difference

# A simplex thinner than this share of the sizes is built anew [-].
THIN = 1e-9


@inner
def off_line(corners, i, j, k):
    """Squared distance of corner k from the line through i and j."""
    ux = corners[j, 0] - corners[i, 0]
    uy = corners[j, 1] - corners[i, 1]
    uz = corners[j, 2] - corners[i, 2]
    wx = corners[k, 0] - corners[i, 0]
    wy = corners[k, 1] - corners[i, 1]
    wz = corners[k, 2] - corners[i, 2]
    cx, cy, cz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    return (cx * cx + cy * cy + cz * cz) / (ux * ux + uy * uy + uz * uz)


@inner
def above_plane(corners, k):
    """Height of corner k over the plane of the corners 0, 1, 2, and that plane's unnormalised n."""
    ux = corners[1, 0] - corners[0, 0]
    uy = corners[1, 1] - corners[0, 1]
    uz = corners[1, 2] - corners[0, 2]
    wx = corners[2, 0] - corners[0, 0]
    wy = corners[2, 1] - corners[0, 1]
    wz = corners[2, 2] - corners[0, 2]
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    height = (
        nx * (corners[k, 0] - corners[0, 0])
        + ny * (corners[k, 1] - corners[0, 1])
        + nz * (corners[k, 2] - corners[0, 2])
    )
    return height / sqrt(nx * nx + ny * ny + nz * nz), nx, ny, nz


@inner
def copy_row(corners, source, target):
    """Copy one corner."""
    for k in range(9):
        corners[target, k] = corners[source, k]


@inner
def swap_rows(corners, i, j):
    """Exchange two corners."""
    for k in range(9):
        corners[i, k], corners[j, k] = corners[j, k], corners[i, k]


@once
def make_tetrahedron(spec):
    """Return `kernel(a, b, ox, oy, oz, count, corners, tables)`: it makes corners 0..3 a volume.

    It keeps what it can of the `count` corners of GJK's simplex, now in `corners`.
    """
    difference = make_difference(spec)

    def tetrahedron(a, b, ox, oy, oz, count, corners, tables):
        thin = (THIN * (a.bound + b.bound)) ** 2
        # The second corner: of those there are, else of six supports, the farthest from the first.
        best, chosen = -1.0, 1
        for k in range(1, count):
            d = (
                (corners[k, 0] - corners[0, 0]) ** 2
                + (corners[k, 1] - corners[0, 1]) ** 2
                + (corners[k, 2] - corners[0, 2]) ** 2
            )
            if d > best:
                best, chosen = d, k
        if best > thin:
            swap_rows(corners, 1, chosen)
        else:
            count = 1
            for side in range(6):
                s = 1.0 if side & 1 else -1.0
                dx, dy, dz = (
                    s if side < 2 else 0.0,
                    s if side // 2 == 1 else 0.0,
                    s if side > 3 else 0.0,
                )
                difference(a, b, ox, oy, oz, dx, dy, dz, tables, corners[4])
                d = (
                    (corners[4, 0] - corners[0, 0]) ** 2
                    + (corners[4, 1] - corners[0, 1]) ** 2
                    + (corners[4, 2] - corners[0, 2]) ** 2
                )
                if d > best:
                    best = d
                    copy_row(corners, 4, 1)
        # The third: farthest from the line.
        best, chosen = -1.0, 2
        for k in range(2, count):
            d = off_line(corners, 0, 1, k)
            if d > best:
                best, chosen = d, k
        if best > thin:
            swap_rows(corners, 2, chosen)
        else:
            count = 2
            ux = corners[1, 0] - corners[0, 0]
            uy = corners[1, 1] - corners[0, 1]
            uz = corners[1, 2] - corners[0, 2]
            if abs(ux) <= abs(uy) and abs(ux) <= abs(uz):
                px, py, pz = 0.0, -uz, uy
            elif abs(uy) <= abs(uz):
                px, py, pz = uz, 0.0, -ux
            else:
                px, py, pz = -uy, ux, 0.0
            scale = 1.0 / sqrt(ux * ux + uy * uy + uz * uz)
            qx = (uy * pz - uz * py) * scale
            qy = (uz * px - ux * pz) * scale
            qz = (ux * py - uy * px) * scale
            for side in range(4):
                s = 1.0 if side & 1 else -1.0
                dx, dy, dz = (px, py, pz) if side < 2 else (qx, qy, qz)
                difference(a, b, ox, oy, oz, s * dx, s * dy, s * dz, tables, corners[4])
                d = off_line(corners, 0, 1, 4)
                if d > best:
                    best = d
                    copy_row(corners, 4, 2)
        # The fourth: farthest from the plane.
        if count == 4:
            height, nx, ny, nz = above_plane(corners, 3)
            if height * height > thin:
                return
        height, nx, ny, nz = above_plane(corners, 2)
        best = -1.0
        for side in range(2):
            s = 1.0 if side else -1.0
            difference(a, b, ox, oy, oz, s * nx, s * ny, s * nz, tables, corners[4])
            height, _, _, _ = above_plane(corners, 4)
            if abs(height) > best:
                best = abs(height)
                copy_row(corners, 4, 3)

    return kernel(tetrahedron, spec)
