"""Corners of a simplex enter; its point nearest to the origin leaves, as barycentric weights.

            r
           / \\         inside the triangle the nearest point is n (n . p) / |n|^2, along the exact
          / x \\        normal even where the distance is round-off of the corners;
         p-----q        beyond an edge (weight of the opposite corner < 0) it lies on that edge

Every corner, edge and face that may hold the point is tried and the nearest wins, which costs a few
dozen operations more than walking the Voronoi regions and cannot lose its way in thin simplices.
"""

from __future__ import annotations

from ...compile import inner

# Triangles whose squared sine is below this have no normal to speak of: their edges are tried.
FLAT = 1e-26


@inner
def nearest_on_segment(px, py, pz, qx, qy, qz):
    """Point of the segment p q nearest to the origin: (x, y, z, weight of p, weight of q)."""
    tx, ty, tz = qx - px, qy - py, qz - pz
    squared = tx * tx + ty * ty + tz * tz
    along = -(px * tx + py * ty + pz * tz)
    if along <= 0.0 or squared == 0.0:
        return px, py, pz, 1.0, 0.0
    if along >= squared:
        return qx, qy, qz, 0.0, 1.0
    share = along / squared
    return px + share * tx, py + share * ty, pz + share * tz, 1.0 - share, share


@inner
def nearest_on_triangle(px, py, pz, qx, qy, qz, rx, ry, rz):
    """Point of the triangle p q r nearest to the origin: (x, y, z, weights of p, q, r)."""
    ux, uy, uz = qx - px, qy - py, qz - pz
    wx, wy, wz = rx - px, ry - py, rz - pz
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    squared = nx * nx + ny * ny + nz * nz
    flat = squared <= FLAT * (ux * ux + uy * uy + uz * uz) * (wx * wx + wy * wy + wz * wz)
    a = b = c = -1.0
    if not flat:
        height = (nx * px + ny * py + nz * pz) / squared
        x, y, z = nx * height, ny * height, nz * height
        ax, ay, az = px - x, py - y, pz - z
        bx, by, bz = qx - x, qy - y, qz - z
        cx, cy, cz = rx - x, ry - y, rz - z
        a = (nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx)) / (
            squared
        )
        b = (nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax)) / (
            squared
        )
        c = 1.0 - a - b
        if a >= 0.0 and b >= 0.0 and c >= 0.0:
            return x, y, z, a, b, c
    best = 1e300
    bx = by = bz = wp = wq = wr = 0.0
    if a < 0.0:
        x, y, z, first, second = nearest_on_segment(qx, qy, qz, rx, ry, rz)
        d = x * x + y * y + z * z
        if d < best:
            best, bx, by, bz, wp, wq, wr = d, x, y, z, 0.0, first, second
    if b < 0.0:
        x, y, z, first, second = nearest_on_segment(px, py, pz, rx, ry, rz)
        d = x * x + y * y + z * z
        if d < best:
            best, bx, by, bz, wp, wq, wr = d, x, y, z, first, 0.0, second
    if c < 0.0:
        x, y, z, first, second = nearest_on_segment(px, py, pz, qx, qy, qz)
        d = x * x + y * y + z * z
        if d < best:
            best, bx, by, bz, wp, wq, wr = d, x, y, z, first, second, 0.0
    return bx, by, bz, wp, wq, wr


@inner
def faces_away(corners, i, j, k, opposite, grain):
    """Whether the origin and the corner `opposite` are not clearly on one side of face i j k.

    In a tetrahedron thinner than `grain` [m] the side of `opposite` is round-off: all faces count.
    """
    px, py, pz = corners[i, 0], corners[i, 1], corners[i, 2]
    ux, uy, uz = corners[j, 0] - px, corners[j, 1] - py, corners[j, 2] - pz
    wx, wy, wz = corners[k, 0] - px, corners[k, 1] - py, corners[k, 2] - pz
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    origin = -(nx * px + ny * py + nz * pz)
    other = (
        nx * (corners[opposite, 0] - px)
        + ny * (corners[opposite, 1] - py)
        + nz * (corners[opposite, 2] - pz)
    )
    flat = other * other <= grain * grain * (nx * nx + ny * ny + nz * nz)
    return origin * other <= 0.0 or flat


@inner
def nearest_on_tetrahedron(corners, weights, grain):
    """Write the weights of the nearest point; returns (inside, x, y, z)."""
    best = 1e300
    x = y = z = 0.0
    for opposite in range(4):
        i = 1 if opposite == 0 else 0
        j = 2 if opposite <= 1 else 1
        k = 3 if opposite <= 2 else 2
        if faces_away(corners, i, j, k, opposite, grain):
            tx, ty, tz, a, b, c = nearest_on_triangle(
                corners[i, 0],
                corners[i, 1],
                corners[i, 2],
                corners[j, 0],
                corners[j, 1],
                corners[j, 2],
                corners[k, 0],
                corners[k, 1],
                corners[k, 2],
            )
            d = tx * tx + ty * ty + tz * tz
            if d < best:
                best, x, y, z = d, tx, ty, tz
                weights[i], weights[j], weights[k], weights[opposite] = a, b, c, 0.0
    return best == 1e300, x, y, z


@inner
def nearest_on_simplex(corners, count, weights, grain):
    """Nearest point of the first `count` corners to the origin; returns (inside, x, y, z).

    grain: round-off of the corners' coordinates [m].
    """
    if count == 4:
        return nearest_on_tetrahedron(corners, weights, grain)
    px, py, pz = corners[0, 0], corners[0, 1], corners[0, 2]
    if count == 1:
        weights[0] = 1.0
        return False, px, py, pz
    qx, qy, qz = corners[1, 0], corners[1, 1], corners[1, 2]
    if count == 2:
        x, y, z, weights[0], weights[1] = nearest_on_segment(px, py, pz, qx, qy, qz)
        return False, x, y, z
    x, y, z, weights[0], weights[1], weights[2] = nearest_on_triangle(
        px, py, pz, qx, qy, qz, corners[2, 0], corners[2, 1], corners[2, 2]
    )
    return False, x, y, z


@inner
def drop_weightless(corners, count, weights):
    """Keep the corners with a weight, in order; returns how many."""
    kept = 0
    for i in range(count):
        if weights[i] > 0.0:
            if kept != i:
                weights[kept] = weights[i]
                for k in range(9):
                    corners[kept, k] = corners[i, k]
            kept += 1
    return kept
