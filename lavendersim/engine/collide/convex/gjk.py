"""Distance of two convex cores, their nearest points and normal, or that they overlap: GJK.

E. G. Gilbert, D. W. Johnson and S. S. Keerthi, A fast procedure for computing the distance between
complex objects in three-dimensional space, IEEE J. Robotics and Automation 4 (1988) 193.

The Minkowski difference M of the cores, all w = a - b of their points, holds the origin exactly
when they overlap. v is the point of the current simplex nearest to the origin; the support point of
M against v joins the simplex until it comes no nearer:

    |v|^2 - v . w <= (rounding)        with v . w / |v| a lower bound of the distance at any time

Coordinates: the world's axes, origin at A's centre; B's centre lies at `offset`.
"""

from __future__ import annotations

from math import sqrt

from ...compile import inner, kernel, once, separate
from ...vectors import Vec3, dot, length, negative, position
from ..records import UNBOUNDED, copy_vertex
from ..scratch import NEW_VERTEX
from ..shape_kernels import make_support
from .simplex import drop_weightless, nearest_on_simplex

# What the walk found out.
APART, FARTHER, OVERLAPPING = 0, 1, 2
# Polyhedra end after some ten rounds, cylinders by the tolerance after some thirty.
ROUNDS = 100
# Remaining gap of the squared distance, relative [-]: the distance is then right to half of it.
GAP = 1e-14
# Round-off of the vertices' coordinates: a few units in the last place of the sizes [-].
GRAIN = 2e-15
# Closer than this share of the shapes' sizes the direction of v is round-off: they touch [-].
CLOSE = 1e-11
# Half a unit in the last place of 1: what a product of lengths loses [-].
EPSILON = 1e-16
# Squared distance of centres, as a share of the sizes', below which any direction may begin [-].
CONCENTRIC = 1e-24


@once
def make_difference(spec):
    """Return `kernel(a, b, offset, direction, hulls, vertex)`: the support mapping of A - B.

    vertex: where the VERTEX that is farthest along `direction` is written.
    """
    support = make_support(spec)

    def difference(a, b, offset, direction, hulls, vertex):
        p = support(a, direction, hulls)
        q = support(b, negative(direction), hulls)
        bx, by, bz = q.x + offset.x, q.y + offset.y, q.z + offset.z
        vertex.x, vertex.y, vertex.z = p.x - bx, p.y - by, p.z - bz
        vertex.ax, vertex.ay, vertex.az = p.x, p.y, p.z
        vertex.bx, vertex.by, vertex.bz = bx, by, bz

    return kernel(difference, spec)


@inner
def is_known(vertices, count):
    """Whether the new vertex is one of the first `count`."""
    new = vertices[NEW_VERTEX]
    for k in range(count):
        old = vertices[k]
        if old.x == new.x and old.y == new.y and old.z == new.z:
            return True
    return False


@inner
def write_separation(found, v, distance, vertices, weights, count):
    """Write the normal against v, the distance and the witness points of a simplex."""
    found.nx, found.ny, found.nz = -v.x / distance, -v.y / distance, -v.z / distance
    found.distance = distance
    ax = ay = az = bx = by = bz = 0.0
    for k in range(count):
        vertex, weight = vertices[k], weights[k]
        ax += weight * vertex.ax
        ay += weight * vertex.ay
        az += weight * vertex.az
        bx += weight * vertex.bx
        by += weight * vertex.by
        bz += weight * vertex.bz
    found.ax, found.ay, found.az = ax, ay, az
    found.bx, found.by, found.bz = bx, by, bz


@once
def make_gjk(spec):
    """Return `kernel(a, b, offset, reach, scratch) -> (APART | FARTHER | OVERLAPPING, count)`.

    APART: `scratch.separation` is filled. FARTHER: the cores are more than `reach` apart [m],
    nothing else is known. OVERLAPPING (or touching): the first `count` vertices of
    `scratch.simplex` hold the origin, to round-off. APART after all ROUNDS, with what was found so
    far, is counted in `scratch.not_converged`.
    """
    difference = make_difference(spec)

    def gjk(a, b, offset, reach, scratch):
        vertices, weights = scratch.simplex, scratch.weights
        size = a.bound + b.bound
        new = vertices[NEW_VERTEX]
        v = negative(offset)
        if dot(v, v) < CONCENTRIC * size * size:
            v = Vec3(size, 0.0, 0.0)
        squared = UNBOUNDED
        count, bound, grain = 0, 0.0, GRAIN * size
        for _ in range(ROUNDS):
            difference(a, b, offset, negative(v), scratch.hulls, new)
            along = dot(v, position(new))
            distance = length(v)
            if along > reach * distance:
                return FARTHER, 0
            bound = max(bound, along / distance)
            if count > 0:
                if squared - along <= GAP * squared + EPSILON * size * distance:
                    break
                if is_known(vertices, count):
                    break
            # The new vertex waits: when it brings nothing the old simplex must still be there.
            copy_vertex(new, vertices[count])
            inside, p = nearest_on_simplex(vertices, count + 1, weights, grain)
            if inside and bound <= grain:
                return OVERLAPPING, 4
            nearer = dot(p, p)
            # Inside after a proof of distance is round-off of a thin simplex; so is no gain.
            if inside or not nearer < squared:
                # Restore the weights of the old simplex.
                nearest_on_simplex(vertices, count, weights, grain)
                break
            v, squared = p, nearer
            count = drop_weightless(vertices, count + 1, weights)
            if squared <= CLOSE * CLOSE * size * size:
                return OVERLAPPING, count
        else:
            scratch.not_converged[0].gjk += 1
        write_separation(scratch.separation[0], v, sqrt(squared), vertices, weights, count)
        return APART, count

    return separate(kernel(gjk, spec), spec)
