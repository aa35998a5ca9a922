"""The point of a simplex nearest to the origin, by barycentric weights: GJK's subproblem.

            r
           / \\         inside the triangle the nearest point is n (n . p) / |n|^2, along the exact
          / x \\        normal even where the distance is round-off of the corners;
         p-----q        beyond an edge (weight of the opposite corner < 0) it lies on that edge

Every corner, edge and face that may hold the point is tried and the nearest wins, which costs a few
dozen operations more than walking the Voronoi regions and cannot lose its way in thin simplices.
"""

from __future__ import annotations

from typing import NamedTuple

from ...compile import inner
from ...vectors import Vec3, cross, dot, minus, plus_scaled, position, scaled
from ..records import UNBOUNDED, copy_vertex

# Triangles whose squared sine is below this have no normal to speak of: their edges are tried.
FLAT = 1e-26


class OnTriangle(NamedTuple):
    """A point of a triangle p q r and its barycentric weights."""

    point: Vec3
    p: float
    q: float
    r: float


@inner
def nearest_on_segment(p, q):
    """Point of the segment p q nearest to the origin: (point, weight of p, weight of q)."""
    t = minus(q, p)
    squared = dot(t, t)
    along = -dot(p, t)
    if along <= 0.0 or squared == 0.0:
        return p, 1.0, 0.0
    if along >= squared:
        return q, 0.0, 1.0
    share = along / squared
    return plus_scaled(p, share, t), 1.0 - share, share


@inner
def nearest_on_triangle(p, q, r):
    """Point of the triangle p q r nearest to the origin."""
    u, w = minus(q, p), minus(r, p)
    n = cross(u, w)
    squared = dot(n, n)
    flat = squared <= FLAT * dot(u, u) * dot(w, w)
    a = b = c = -1.0
    if not flat:
        foot = scaled(dot(n, p) / squared, n)
        to_p, to_q, to_r = minus(p, foot), minus(q, foot), minus(r, foot)
        a = dot(n, cross(to_q, to_r)) / squared
        b = dot(n, cross(to_r, to_p)) / squared
        c = 1.0 - a - b
        if a >= 0.0 and b >= 0.0 and c >= 0.0:
            return OnTriangle(foot, a, b, c)
    best, nearest = UNBOUNDED, OnTriangle(Vec3(0.0, 0.0, 0.0), 0.0, 0.0, 0.0)
    if a < 0.0:
        x, first, second = nearest_on_segment(q, r)
        d = dot(x, x)
        if d < best:
            best, nearest = d, OnTriangle(x, 0.0, first, second)
    if b < 0.0:
        x, first, second = nearest_on_segment(p, r)
        d = dot(x, x)
        if d < best:
            best, nearest = d, OnTriangle(x, first, 0.0, second)
    if c < 0.0:
        x, first, second = nearest_on_segment(p, q)
        d = dot(x, x)
        if d < best:
            best, nearest = d, OnTriangle(x, first, second, 0.0)
    return nearest


@inner
def faces_away(p, q, r, opposite, grain):
    """Whether the origin and the corner `opposite` are not clearly on one side of face p q r.

    In a tetrahedron thinner than `grain` [m] the side of `opposite` is round-off: all faces count.
    """
    n = cross(minus(q, p), minus(r, p))
    origin = -dot(n, p)
    other = dot(n, minus(opposite, p))
    flat = other * other <= grain * grain * dot(n, n)
    return origin * other <= 0.0 or flat


@inner
def nearest_on_tetrahedron(vertices, weights, grain):
    """Write the weights of the nearest point; returns (inside, point)."""
    best = UNBOUNDED
    nearest = Vec3(0.0, 0.0, 0.0)
    for opposite in range(4):
        i = 1 if opposite == 0 else 0
        j = 2 if opposite <= 1 else 1
        k = 3 if opposite <= 2 else 2
        p, q, r = position(vertices[i]), position(vertices[j]), position(vertices[k])
        if faces_away(p, q, r, position(vertices[opposite]), grain):
            found = nearest_on_triangle(p, q, r)
            d = dot(found.point, found.point)
            if d < best:
                best, nearest = d, found.point
                weights[i], weights[j], weights[k] = found.p, found.q, found.r
                weights[opposite] = 0.0
    return best == UNBOUNDED, nearest


@inner
def nearest_on_simplex(vertices, count, weights, grain):
    """Nearest point of the first `count` vertices to the origin; returns (inside, point).

    grain: round-off of the vertices' coordinates [m].
    """
    if count == 4:
        return nearest_on_tetrahedron(vertices, weights, grain)
    p = position(vertices[0])
    if count == 1:
        weights[0] = 1.0
        return False, p
    q = position(vertices[1])
    if count == 2:
        nearest, weights[0], weights[1] = nearest_on_segment(p, q)
        return False, nearest
    found = nearest_on_triangle(p, q, position(vertices[2]))
    weights[0], weights[1], weights[2] = found.p, found.q, found.r
    return False, found.point


@inner
def drop_weightless(vertices, count, weights):
    """Keep the vertices with a weight, in order; returns how many."""
    kept = 0
    for i in range(count):
        if weights[i] > 0.0:
            if kept != i:
                weights[kept] = weights[i]
                copy_vertex(vertices[i], vertices[kept])
            kept += 1
    return kept
