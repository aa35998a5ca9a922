"""Normal of the nearest points of a convex core A and an ellipsoid B, by Newton's method.

    s(n) = n . g(n),   g(n) = offset + p_B(-n) - q_A(n),   dg/dn = -(R_B + R_A)
n leads from A to B; q_A, p_B are the points of the surfaces with the normals n and -n, R their
radii of curvature as matrices across n. s is the separation along n, greatest where g is along n:
    (R_A + R_B + s) d = g - s n,   n <- (n + d) / |n + d|
The step is Newton's; it is halved while s would fall. The matrix is positive definite where bodies
are apart or overlap by less than the least radius of curvature, so that near the nearest points
each round squares the error.

A core that is no smooth body is taken by its parts, each as if it went on: a corner (R = 0), an
edge or axis (n across it), a rim (a circle), a cone's
side (n leans by half its angle). GJK's last simplex says which may be nearest. That a
part is, its normal proves: nothing of A lies farther along n, and the nearest point of the part is
one of A's. If no part has its proof a face is nearest, whose normal is known, or round-off hides
which: then the normal counts that separates the whole bodies most.
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from ...compile import inner, kernel, once
from ...records import CONE, CYLINDER, ELLIPSOID
from ...vectors import (
    Vec3,
    across,
    cross,
    divided,
    dot,
    from_body,
    into_body,
    length,
    minus,
    negative,
    plus_scaled,
    scaled,
)
from ..shape_kernels import make_best_face, make_radius
from ..shapes import shapes_in
from ..shapes.cone import APEX, lean, slant
from ..shapes.ellipsoid import point_of_normal, turned_by
from .separation import make_separation_along

# Newton's rounds: from a normal that is 1e-6 off two suffice; 20 from anywhere.
ROUNDS = 30
HALVINGS = 20
# A step shorter than this leaves an error of its square [rad].
DONE = 1e-8
# What round-off takes of a separation, and of what proves a normal, as a share of the sizes [-].
ROUND_OFF, PROVED = 1e-15, 1e-13
# Vertices nearer to each other than this share of the sizes are one corner [-].
SAME = 1e-9
# Parts of a core.
CORNER, AXIS, CIRCLE, SMOOTH, SIDE = 0, 1, 2, 3, 4


class CorePart(NamedTuple):
    """A part of A's core that goes on for ever; relative to A's centre, world axes."""

    kind: int
    point: Vec3  # the corner, the middle of the edge or axis, the circle's centre, the apex
    along: Vec3  # unit, of the edge or axis; of the circle across its plane
    half: float  # length of the edge or axis, whole of a cone's side [m]
    radius: float  # of the circle, or that A has around the axis [m]; of a side its sine `lean`


class Offer(NamedTuple):
    """A normal, what the cores are apart along it [m], and whether no other separates more."""

    normal: Vec3
    separation: float
    proved: bool
    start: Vec3  # the normal that searches begin at


@inner
def unit(v):
    """Return v / |v|."""
    return divided(v, length(v))


@inner
def circle_point(part, n):
    """Return (the circle's point farthest along n, how far n reaches across its axis)."""
    side = plus_scaled(n, -dot(n, part.along), part.along)
    reach = length(side)
    if reach == 0.0:
        return part.point, 0.0
    return plus_scaled(part.point, part.radius / reach, side), reach


@inner
def on_side(part, n):
    """Return the unit vector nearest to n that leans as a cone's side does; n along the axis."""
    out = plus_scaled(n, -dot(n, part.along), part.along)
    if length(out) <= SAME:
        return n
    out = unit(out)  # twice, as round-off of a short one is along the axis
    out = unit(plus_scaled(out, -dot(out, part.along), part.along))
    return plus_scaled(scaled(part.radius, part.along), leaning_cosine(part), out)


@inner
def leaning_cosine(part):
    """Return the cosine of half a cone's angle."""
    return sqrt((1.0 - part.radius) * (1.0 + part.radius))


@once
def make_gap(spec: Any) -> Any:
    """Return `kernel(a, b, offset, part, n) -> g(n)`."""
    smooth = spec.collides("ellipsoid_ellipsoid")

    def gap(a, b, offset, part, n):
        p, _ = point_of_normal(b, into_body(b, negative(n)))
        at = from_body(b, p)
        q = part.point
        if part.kind == CIRCLE:
            q, _ = circle_point(part, n)
        if smooth:
            if part.kind == SMOOTH:
                q, _ = point_of_normal(a, into_body(a, n))
                q = from_body(a, q)
        return Vec3(offset.x + at.x - q.x, offset.y + at.y - q.y, offset.z + at.z - q.z)

    return kernel(gap, spec)


@once
def make_newton_step(spec: Any) -> Any:
    """Return `kernel(a, b, part, n, g) -> (d, whether s is concave here)`."""
    smooth, cones = spec.collides("ellipsoid_ellipsoid"), spec.collides("ellipsoid_cone")

    def newton_step(a, b, part, n, g):
        s = dot(n, g)
        u = unit(cross(part.along, n)) if part.kind == AXIS else unit(across(n))
        w = cross(n, u)
        local_u, local_w = into_body(b, u), into_body(b, w)
        p, h = point_of_normal(b, into_body(b, negative(n)))
        uu = s + turned_by(b, p, h, local_u, local_u)
        if part.kind == AXIS:
            if not uu > 0.0:
                return u, False
            return scaled(dot(u, g) / uu, u), True
        if cones:
            if part.kind == SIDE:
                # Round the axis: n = cos a e(t) + sin a z, s'' = -(cos a e . g + cos^2 a R).
                cosine, t = leaning_cosine(part), unit(cross(part.along, n))
                out = plus_scaled(n, -part.radius, part.along)
                local = into_body(b, t)
                bend = dot(out, g) + cosine * cosine * turned_by(b, p, h, local, local)
                if not bend > 0.0:
                    return t, False
                return scaled(cosine * cosine * dot(t, g) / bend, t), True
        uw = turned_by(b, p, h, local_u, local_w)
        ww = s + turned_by(b, p, h, local_w, local_w)
        if part.kind == CIRCLE:
            _, reach = circle_point(part, n)
            if reach == 0.0:
                return u, False
            tangent, radius = divided(cross(part.along, n), reach), part.radius / reach
            tu, tw = dot(tangent, u), dot(tangent, w)
            uu, uw, ww = uu + radius * tu * tu, uw + radius * tu * tw, ww + radius * tw * tw
        if smooth:
            if part.kind == SMOOTH:
                local_u, local_w = into_body(a, u), into_body(a, w)
                p, h = point_of_normal(a, into_body(a, n))
                uu += turned_by(a, p, h, local_u, local_u)
                uw += turned_by(a, p, h, local_u, local_w)
                ww += turned_by(a, p, h, local_w, local_w)
        determinant = uu * ww - uw * uw
        if not (uu > 0.0 and determinant > 0.0):
            return u, False
        gu, gw = dot(u, g), dot(w, g)
        d = scaled((ww * gu - uw * gw) / determinant, u)
        return plus_scaled(d, (uu * gw - uw * gu) / determinant, w), True

    return kernel(newton_step, spec)


@once
def make_normal_of_part(spec: Any) -> Any:
    """Return `kernel(a, b, offset, part, n) -> n` that separates a part of A and B most, near n."""
    gap, newton_step = make_gap(spec), make_newton_step(spec)
    cones = spec.collides("ellipsoid_cone")

    def normal_of_part(a, b, offset, part, n):
        if part.kind == AXIS:
            n = plus_scaled(n, -dot(n, part.along), part.along)
            if length(n) == 0.0:
                return part.along
            n = unit(n)
        if cones:
            if part.kind == SIDE:
                n = on_side(part, n)
        g = gap(a, b, offset, part, n)
        s, grain = dot(n, g), ROUND_OFF * (a.bound + b.bound)
        for _ in range(ROUNDS):
            d, concave = newton_step(a, b, part, n, g)
            if not concave:
                break
            share, rises = 1.0, False
            m, g_m, s_m = n, g, s
            for _ in range(HALVINGS):
                m = unit(plus_scaled(n, share, d))
                if cones:
                    if part.kind == SIDE:
                        m = on_side(part, m)
                g_m = gap(a, b, offset, part, m)
                s_m = dot(m, g_m)
                if s_m >= s - grain:
                    rises = True
                    break
                share *= 0.5
            if not rises:
                break
            n, g, s = m, g_m, s_m
            if share * length(d) < DONE:
                break
        return n

    return kernel(normal_of_part, spec)


@inner
def beyond(part, n, g):
    """How far g is from what it is where a part is nearest to B [m]: along n, but for an edge."""
    off = plus_scaled(g, -dot(n, g), n)
    if part.kind == SIDE:
        # From the apex down the side.
        cosine = leaning_cosine(part)
        down = scaled(1.0 / cosine, plus_scaled(scaled(part.radius, n), -1.0, part.along))
        along = dot(off, down)
        outside = max(-along, max(along - part.half, 0.0))
        return outside + length(plus_scaled(off, -along, down))
    if part.kind != AXIS:
        return length(off)
    along = dot(off, part.along)
    outside = max(abs(along) - part.half, 0.0)
    return outside + length(plus_scaled(off, -along, part.along))


@once
def make_offered(spec: Any) -> Any:
    """Return `kernel(a, b, offset, part, best, hulls)`: the better of `best` and it."""
    normal_of_part, separation_along = make_normal_of_part(spec), make_separation_along(spec)
    gap, radius = make_gap(spec), make_radius(spec)

    def offered(a, b, offset, part, best, hulls):
        if best.proved:
            return best
        n = normal_of_part(a, b, offset, part, best.start)
        g, s = gap(a, b, offset, part, n), separation_along(a, b, offset, n, hulls)
        of_part = dot(n, g) + radius(b)
        if part.kind == AXIS:
            of_part -= part.radius
        size = a.bound + b.bound
        proved = beyond(part, n, g) + max(of_part - s, 0.0) <= PROVED * size
        # What is proved nearby separates no less than its start, but for round-off.
        if s > best.separation or (proved and s >= best.separation - PROVED * size):
            return Offer(n, s, proved, best.start)
        return best

    return kernel(offered, spec)


@once
def make_of_vertices(spec: Any) -> Any:
    """Return `kernel(a, b, offset, best, count, scratch) -> Offer`, of corners and edges."""
    offered = make_offered(spec)

    def of_vertices(a, b, offset, best, count, scratch):
        vertices, hulls = scratch.simplex, scratch.hulls
        least = SAME * (a.bound + b.bound)
        none = Vec3(0.0, 0.0, 0.0)
        for i in range(count):
            p = witness(vertices[i])
            known = False
            for k in range(i):
                known = known or length(minus(p, witness(vertices[k]))) <= least
            if known:
                continue
            corner = CorePart(CORNER, p, none, 0.0, 0.0)
            best = offered(a, b, offset, corner, best, hulls)
            for k in range(i):
                between = minus(p, witness(vertices[k]))
                edge = length(between)
                if edge > least:
                    middle = plus_scaled(p, -0.5, between)
                    line = CorePart(AXIS, middle, divided(between, edge), 0.5 * edge, 0.0)
                    best = offered(a, b, offset, line, best, hulls)
        return best

    return kernel(of_vertices, spec)


@inner
def witness(vertex):
    """Return the point of A of a vertex of the Minkowski difference."""
    return Vec3(vertex.ax, vertex.ay, vertex.az)


@once
def make_of_cylinder(spec: Any) -> Any:
    """Return `kernel(a, b, offset, best, hulls) -> Offer`, of the side and a rim."""
    offered = make_offered(spec)

    def of_cylinder(a, b, offset, best, hulls):
        axis = Vec3(a.r02, a.r12, a.r22)
        end = a.hz if dot(axis, best.start) >= 0.0 else -a.hz
        side = CorePart(AXIS, Vec3(0.0, 0.0, 0.0), axis, a.hz, a.hx)
        best = offered(a, b, offset, side, best, hulls)
        rim = CorePart(CIRCLE, scaled(end, axis), axis, 0.0, a.hx)
        return offered(a, b, offset, rim, best, hulls)

    return kernel(of_cylinder, spec)


@once
def make_of_cone(spec: Any) -> Any:
    """Return `kernel(a, b, offset, best, hulls) -> Offer`, of the side, the apex and the rim."""
    offered = make_offered(spec)

    def of_cone(a, b, offset, best, hulls):
        axis, none = Vec3(a.r02, a.r12, a.r22), Vec3(0.0, 0.0, 0.0)
        apex = scaled(APEX * a.hz, axis)
        side = CorePart(SIDE, apex, axis, slant(a), lean(a))
        best = offered(a, b, offset, side, best, hulls)
        best = offered(a, b, offset, CorePart(CORNER, apex, none, 0.0, 0.0), best, hulls)
        rim = CorePart(CIRCLE, scaled(-a.hz, axis), axis, 0.0, a.hx)
        return offered(a, b, offset, rim, best, hulls)

    return kernel(of_cone, spec)


@once
def make_smooth_normal(spec: Any) -> Any:
    """Return `kernel(a, b, offset, n, count, scratch) -> Offer`: of cores, B's an ellipsoid's.

    n: near it. The first `count` vertices of `scratch.simplex` are those that GJK ended with.
    """
    separation_along, best_face = make_separation_along(spec), make_best_face(spec)
    offered, kinds = make_offered(spec), {shape.kind for shape in shapes_in(spec)}
    cylinders, smooth = CYLINDER in kinds, spec.collides("ellipsoid_ellipsoid")
    of_vertices = make_of_vertices(spec)
    of_cylinder: Any = make_of_cylinder(spec) if cylinders else None
    cones = spec.collides("ellipsoid_cone")
    of_cone: Any = make_of_cone(spec) if cones else None

    def smooth_normal(a, b, offset, n, count, scratch):
        hulls = scratch.hulls
        best = Offer(n, separation_along(a, b, offset, n, hulls), False, n)
        if smooth:
            if a.shape == ELLIPSOID:
                none = Vec3(0.0, 0.0, 0.0)
                whole = CorePart(SMOOTH, none, none, 0.0, 0.0)
                return offered(a, b, offset, whole, best, hulls)
        by_parts = True
        if cylinders:
            if a.shape == CYLINDER:
                best = of_cylinder(a, b, offset, best, hulls)
                by_parts = False
        if cones:
            if a.shape == CONE:
                best = of_cone(a, b, offset, best, hulls)
                by_parts = False
        if by_parts:
            best = of_vertices(a, b, offset, best, count, scratch)
        if best.proved:
            return best
        face, outward = best_face(a, best.normal, hulls)
        if face >= 0:
            s = separation_along(a, b, offset, outward, hulls)
            if s >= best.separation - ROUND_OFF * (a.bound + b.bound):
                return Offer(outward, s, False, n)
        return best

    return kernel(smooth_normal, spec)
