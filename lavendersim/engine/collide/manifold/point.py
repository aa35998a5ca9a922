"""Manifold points enter, the four that span most area leave.

A narrow-phase kernel writes candidate points into a small scratch array and returns how many; the
normal is shared by the manifold. `keep_four` reduces without moving points, so a resting box keeps
the support polygon that matters for its balance.
"""

from __future__ import annotations

from ...compile import inner

# Points that `keep_four` exchanges at most: three are kept beside the deepest, most fit at once.
EXCHANGES = 4


@inner
def place(point, x, y, z, phi, feature):
    """Write one candidate point."""
    point.x, point.y, point.z = x, y, z
    point.phi = phi
    point.feature = feature


@inner
def copy_point(source, target):
    """Copy a point field by field (records are references)."""
    target.x, target.y, target.z = source.x, source.y, source.z
    target.phi = source.phi
    target.feature = source.feature
    target.in_line, target.out_line = source.in_line, source.out_line


@inner
def swap_points(a, b):
    """Exchange two points."""
    ax, ay, az, phi, feature = a.x, a.y, a.z, a.phi, a.feature
    in_line, out_line = a.in_line, a.out_line
    copy_point(b, a)
    place(b, ax, ay, az, phi, feature)
    b.in_line, b.out_line = in_line, out_line


@inner
def signed_area(p, q, r, nx, ny, nz):
    """Twice the area of triangle p q r, positive when it turns left about n [m^2]."""
    ux, uy, uz = q.x - p.x, q.y - p.y, q.z - p.z
    wx, wy, wz = r.x - p.x, r.y - p.y, r.z - p.z
    return nx * (uy * wz - uz * wy) + ny * (uz * wx - ux * wz) + nz * (ux * wy - uy * wx)


@inner
def quadrilateral(p, q, r, s, nx, ny, nz):
    """Twice the area spanned by four points in any order, if none lies between the others [m^2].

    The diagonals of the largest of the three loops through them: |pr x qs| and its like.
    """
    pq = signed_area(p, q, r, nx, ny, nz) + signed_area(p, r, s, nx, ny, nz)
    pr = signed_area(p, r, q, nx, ny, nz) + signed_area(p, q, s, nx, ny, nz)
    ps = signed_area(p, q, s, nx, ny, nz) + signed_area(p, s, r, nx, ny, nz)
    return max(abs(pq), max(abs(pr), abs(ps)))


@inner
def exchange(points, count, nx, ny, nz):
    """Replace each of points 1..3 by one of the others while that spans more.

    A body half over an edge keeps both ends of it, so that it is carried up to the edge.
    """
    best = quadrilateral(points[0], points[1], points[2], points[3], nx, ny, nz)
    for _ in range(EXCHANGES):
        out, chosen = -1, -1
        for k in range(1, 4):
            p = points[2 if k == 1 else 1]
            q = points[2 if k == 3 else 3]
            for i in range(4, count):
                area = quadrilateral(points[0], p, q, points[i], nx, ny, nz)
                if area > best * (1.0 + 1e-9):
                    best, out, chosen = area, k, i
        if out < 0:
            break
        swap_points(points[out], points[chosen])


@inner
def keep_four(points, count, nx, ny, nz):
    """Order `points` so that the first four are the deepest and the largest quadrilateral with it.

    The deepest point comes first, the farthest from it second, then the one that makes the largest
    triangle, then the one that adds most area outside that triangle; last, all but the deepest are
    exchanged for better ones. Returns the new count.
    """
    if count <= 4:
        return count
    deepest = 0
    for i in range(1, count):
        # The margin keeps the choice when depths differ by round-off only.
        if points[i].phi < points[deepest].phi - 1e-9:
            deepest = i
    swap_points(points[0], points[deepest])
    best, chosen = -1.0, 1
    for i in range(1, count):
        dx, dy, dz = (
            points[i].x - points[0].x,
            points[i].y - points[0].y,
            points[i].z - points[0].z,
        )
        distance = dx * dx + dy * dy + dz * dz
        if distance > best * (1.0 + 1e-9):
            best, chosen = distance, i
    swap_points(points[1], points[chosen])
    best, chosen = -1.0, 2
    for i in range(2, count):
        area = abs(signed_area(points[0], points[1], points[i], nx, ny, nz))
        if area > best * (1.0 + 1e-9):
            best, chosen = area, i
    swap_points(points[2], points[chosen])
    turn = signed_area(points[0], points[1], points[2], nx, ny, nz)
    side = 1.0 if turn >= 0.0 else -1.0
    best, chosen = 0.0, -1
    for i in range(3, count):
        # Outside an edge of the triangle the area with that edge is negative.
        gain = 0.0
        gain = max(gain, -side * signed_area(points[0], points[1], points[i], nx, ny, nz))
        gain = max(gain, -side * signed_area(points[1], points[2], points[i], nx, ny, nz))
        gain = max(gain, -side * signed_area(points[2], points[0], points[i], nx, ny, nz))
        if gain > best * (1.0 + 1e-9) + 1e-18:
            best, chosen = gain, i
    if chosen < 0:
        return 3
    swap_points(points[3], points[chosen])
    exchange(points, count, nx, ny, nz)
    return 4
