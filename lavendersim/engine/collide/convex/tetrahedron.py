"""The first polytope of EPA: four vertices of the Minkowski difference that span a volume.

GJK ends with one to four vertices (gjk.py). Whatever of them spans a line, a plane and a volume is
kept; the rest is looked for across what there is.
"""

from __future__ import annotations

from ...compile import inner, kernel, once
from ...vectors import Vec3, across, cross, dot, length, minus, negative, position, scaled
from ..records import copy_vertex
from ..scratch import NEW_VERTEX
from .gjk import make_difference

# A simplex thinner than this share of the sizes is built anew [-].
THIN = 1e-9


@inner
def off_point(vertices, i, k):
    """Squared distance of vertex k from vertex i."""
    d = minus(position(vertices[k]), position(vertices[i]))
    return dot(d, d)


@inner
def off_line(vertices, i, j, k):
    """Squared distance of vertex k from the line through i and j."""
    p = position(vertices[i])
    u = minus(position(vertices[j]), p)
    c = cross(u, minus(position(vertices[k]), p))
    return dot(c, c) / dot(u, u)


@inner
def above_plane(vertices, k):
    """Height of vertex k over the plane of 0, 1, 2, and that plane's normal n, not normalised."""
    p = position(vertices[0])
    n = cross(minus(position(vertices[1]), p), minus(position(vertices[2]), p))
    return dot(n, minus(position(vertices[k]), p)) / length(n), n


@inner
def swap_vertices(vertices, i, j):
    """Exchange two vertices."""
    p, q = vertices[i], vertices[j]
    p.x, q.x = q.x, p.x
    p.y, q.y = q.y, p.y
    p.z, q.z = q.z, p.z
    p.ax, q.ax = q.ax, p.ax
    p.ay, q.ay = q.ay, p.ay
    p.az, q.az = q.az, p.az
    p.bx, q.bx = q.bx, p.bx
    p.by, q.by = q.by, p.by
    p.bz, q.bz = q.bz, p.bz


@inner
def along_an_axis(side):
    """One of the six directions along the world's axes."""
    s = 1.0 if side & 1 else -1.0
    return Vec3(s if side < 2 else 0.0, s if side // 2 == 1 else 0.0, s if side > 3 else 0.0)


@inner
def across_line(u):
    """Two directions across u and each other, as long as u's larger components."""
    p = negative(across(u))
    return p, scaled(1.0 / length(u), cross(u, p))


@once
def make_tetrahedron(spec):
    """Return `kernel(a, b, offset, count, vertices, hulls)`: it makes vertices 0..3 a volume.

    It keeps what it can of the `count` vertices of GJK's simplex, now in `vertices`.
    """
    difference = make_difference(spec)

    def tetrahedron(a, b, offset, count, vertices, hulls):
        thin = (THIN * (a.bound + b.bound)) ** 2
        new = vertices[NEW_VERTEX]
        # The second vertex: of those there are, else of six supports, the farthest from the first.
        best, chosen = -1.0, 1
        for k in range(1, count):
            d = off_point(vertices, 0, k)
            if d > best:
                best, chosen = d, k
        if best > thin:
            swap_vertices(vertices, 1, chosen)
        else:
            count = 1
            for side in range(6):
                difference(a, b, offset, along_an_axis(side), hulls, new)
                d = off_point(vertices, 0, NEW_VERTEX)
                if d > best:
                    best = d
                    copy_vertex(new, vertices[1])
        # The third: farthest from the line.
        best, chosen = -1.0, 2
        for k in range(2, count):
            d = off_line(vertices, 0, 1, k)
            if d > best:
                best, chosen = d, k
        if best > thin:
            swap_vertices(vertices, 2, chosen)
        else:
            count = 2
            p, q = across_line(minus(position(vertices[1]), position(vertices[0])))
            for side in range(4):
                s = 1.0 if side & 1 else -1.0
                direction = scaled(s, p if side < 2 else q)
                difference(a, b, offset, direction, hulls, new)
                d = off_line(vertices, 0, 1, NEW_VERTEX)
                if d > best:
                    best = d
                    copy_vertex(new, vertices[2])
        # The fourth: farthest from the plane.
        if count == 4:
            height, n = above_plane(vertices, 3)
            if height * height > thin:
                return
        height, n = above_plane(vertices, 2)
        best = -1.0
        for side in range(2):
            s = 1.0 if side else -1.0
            difference(a, b, offset, scaled(s, n), hulls, new)
            height, _ = above_plane(vertices, NEW_VERTEX)
            if abs(height) > best:
                best = abs(height)
                copy_vertex(new, vertices[3])

    return kernel(tetrahedron, spec)
