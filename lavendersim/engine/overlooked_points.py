"""Points ahead that a part of a step has no rows of, and that its solve leads into each other.

Which rows a part has is decided before its solve: of a manifold four points, by where they are; of
those ahead not the ones that part, by how they move. But what pushes at one point turns the body
about it, and another one comes down: the rim of a disc that lands on its opposite edge. So the
points without rows are looked at once the velocities are known. Where one would overlap by more
than DEEP at the end, the part is made again,

    with every point of its manifold, where the manifold was reduced (`whole` of the pair);
    up to where it meets, where it parts at first and comes back as fast as an impact does.

What comes back more slowly, or so soon that the part would be none, is a contact of the part: its
pair is whole, too, and none of its rows waits.
A part whose solve leads nothing into each other is made once, to the same bits.

Corners that touch between two flat faces may be what carries the body: a prism of six sides leans
on two of its corners near its tipping angle, and of four that were kept those may be none. Such a
corner may sink by the slop and no more. A rim has points without end, of which each new step finds
a lower one; there DEEP is what keeps parts from being made again.
"""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import Any

from .approach import CREEP, NEVER, OVERLAP, make_forced, make_rate, normal
from .collide.nearest_image import place_beside
from .compile import inner, kernel
from .foreseen_impacts import FLIGHT, make_is_impact
from .integrate import ALWAYS
from .records import BOX, HULL, MESH, PLANE, SPHERE, TOUCHING
from .spec import Spec
from .step_terms import step_terms
from .stiff_springs import make_restitution_of, may_rebound
from .vectors import Vec3, cross, dot, length, minus, position

# What a part may lead a point without a row into the other surface [m]: the next part would give up
# the order of impacts for more.
DEEP = OVERLAP


@inner
def has_flat_faces(body):
    """Whether all its faces are flat: what is round leaves a face along that face's plane."""
    return body.shape == BOX or body.shape == HULL


@inner
def is_flat(body):
    """Whether it touches what is flat by corners alone."""
    return has_flat_faces(body) or body.shape == PLANE or body.shape == MESH


@inner
def depth_allowed(point, a, b, params):
    """Return how far a part may lead a point into the other surface [m]; a, b: its bodies."""
    closed = max(params.slop, TOUCHING)
    if point.waits == 0 and point.phi <= closed and is_flat(a) and is_flat(b):
        return min(closed, DEEP)
    return DEEP


def make_note_left_out(spec: Spec) -> Any:
    """Return `kernel(pair, a, b, count, n, workspace) -> whether there is room`.

    Notes the points behind the first `count` of `scratch.manifold`.
    """
    from .collide.manifold.own_normals import has_own_normals, point_normal
    from .collide.manifold.point import LEFT_OUT

    own_normals = has_own_normals(spec)

    def note_left_out(pair, a, b, count, n, workspace):
        manifold, overlooked = workspace.collision.manifold, workspace.overlooked
        noted, left_out = overlooked.noted[0], manifold.reduction[LEFT_OUT]
        # The other half is for rows that wait.
        if noted + left_out > overlooked.points.shape[0] // 2:
            return False
        for k in range(count, count + left_out):
            row, point = overlooked.points[noted], manifold.points[k]
            row.pair, row.a, row.b, row.waits = pair, a, b, 0
            row.x, row.y, row.z, row.phi = point.x, point.y, point.z, point.phi
            if own_normals:
                n = point_normal(manifold, k)
            row.nx, row.ny, row.nz = n.x, n.y, n.z
            noted += 1
        overlooked.noted[0] = noted
        return True

    return kernel(note_left_out, spec)


def make_note_waiting(spec: Spec) -> Any:
    """Return `kernel(contact, overlooked)`: its row waits for a later part."""

    def note_waiting(contact, overlooked):
        row = overlooked.points[overlooked.noted[0]]
        row.pair, row.a, row.b, row.waits = contact.pair, contact.a, contact.b, 1
        row.x, row.y, row.z, row.phi = contact.x, contact.y, contact.z, contact.phi
        row.nx, row.ny, row.nz = contact.nx, contact.ny, contact.nz
        overlooked.noted[0] += 1

    return kernel(note_waiting, spec)


def make_look_over(spec: Spec) -> Any:
    """Return `kernel(state, poses, overlooked, params) -> length`, of a part that is solved.

    poses: rows of the bodies as the part began. length: 0 where nothing overlaps; else the longest
    that the part may be when it is made again [s]. Its bodies are classified (`integrate`).
    """
    rate, turns = make_rate(spec), step_terms(spec).turns
    forced, is_impact = make_forced(spec), make_is_impact(spec)
    restitution = may_rebound(spec)
    restitution_of: Any = make_restitution_of(spec) if restitution else None
    beside = place_beside(spec)

    def turned(n, w, arm, dt):
        # What turning the arm moves its end along n, beside what its rate at the start does [m].
        angle = dt * length(w)
        if angle == 0.0:
            return 0.0
        along = dot(w, arm)
        squared = dot(w, w)
        out = (dot(n, w) * along / squared - dot(n, arm)) * (1.0 - cos(angle))
        return out + dot(n, cross(w, arm)) * (sin(angle) / angle - 1.0) * dt

    turned = kernel(turned, spec)

    def meets(point, pair, speed, motion, params):
        # Whether that is an impact; slower it is a contact of the motion, as any is.
        e = 0.0
        if restitution:
            e = restitution_of(pair, speed)
        dv, most = forced(point, motion)
        return is_impact(speed, CREEP, dv, most, e, params)

    meets = kernel(meets, spec)

    def share(m):
        # Of what the part changes of a body's velocity, how much it moves by: see `displace`.
        return 1.0 if m.carried == ALWAYS else 0.5

    share = kernel(share, spec)

    def spin(v, m, share):
        x, y, z = v.wx - m.wx, v.wy - m.wy, v.wz - m.wz
        return Vec3(m.wx + share * x, m.wy + share * y, m.wz + share * z)

    spin = kernel(spin, spec)

    def look_over(state, poses, overlooked, params):
        pairs, velocities, motion = state.pairs, state.velocities, state.motion
        dt, longest, again = params.dt, NEVER, False
        for k in range(overlooked.noted[0]):
            point = overlooked.points[k]
            n, a, b = normal(point), point.a, point.b
            if poses[a].shape == SPHERE or poses[b].shape == SPHERE:  # no push turns it in
                continue
            arm_a = minus(position(point), position(poses[a]))
            arm_b = minus(position(point), beside(poses[a], poses[b]))
            va, vb, ma, mb = velocities[a], velocities[b], motion[a], motion[b]
            first, last = rate(n, ma, mb, arm_a, arm_b), rate(n, va, vb, arm_a, arm_b)
            across = rate(n, va, mb, arm_a, arm_b)
            share_a, share_b = share(ma), share(mb)
            moved = first + share_b * (last - across) - share_a * (first - across)
            limit = -depth_allowed(point, poses[a], poses[b], params) - max(point.phi, 0.0)
            if not moved * dt < limit:
                continue
            mean = 0.5 * (first + last)
            if turns:
                by_a, by_b = spin(va, ma, share_a), spin(vb, mb, share_b)
                moved += (turned(n, by_b, arm_b, dt) - turned(n, by_a, arm_a, dt)) / dt
                by_a, by_b = spin(va, ma, 0.5), spin(vb, mb, 0.5)
                mean += (turned(n, by_b, arm_b, dt) - turned(n, by_a, arm_a, dt)) / dt
            if not moved * dt < limit:
                continue
            pair = pairs[point.pair]
            if first > 0.0 or point.waits == 1:
                # phi + first t + (mean - first) t^2/dt = 0, in the form that does not cancel.
                gap, half = max(point.phi, 0.0), (mean - first) / dt
                root = sqrt(max(first * first - 4.0 * half * gap, 0.0))
                due = 2.0 * gap / (root - first) if first < 0.0 else (first + root) / (-2.0 * half)
                if due >= FLIGHT * params.timestep and meets(point, pair, root, motion, params):
                    if due < dt:
                        longest, again = min(longest, due), True
                    continue
            if pair.whole == 0:
                pair.whole, again = 1, True
        return min(longest, dt) if again else 0.0

    return kernel(look_over, spec)


def make_forget_whole(spec: Spec) -> Any:
    """Return `kernel(pairs, listed)`: manifolds are reduced again."""

    def forget_whole(pairs, listed):
        for p in range(listed):
            pairs[p].whole = 0

    return kernel(forget_whole, spec)
