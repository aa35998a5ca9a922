"""Newton's method for one spring in full: its impulse together with how both its bodies turn.

Unknown are J and the mean spins omega of A and B (`spring_midpoint`, `spring_turn`), world frame:
    E = I omega - P_0 - L/2 + dt/2 omega x (I omega + L/2) = 0    each body; L = L' + r_m(omega) x J
    N = J - dt F u = 0,    X = (X_0 + X_1)/2 = Y + r_m,B - r_m,A - c J,    c = dt (1/m_A + 1/m_B)/4
I, P_0: inertia and momentum as the step begins; L': of all else; the cross product is left out of
round bodies. With the derivatives, 3 x 3 each,
    | E_A  0    G_A |   the spins are eliminated: (N_J - sum H E^-1 G) dJ = -N + sum H E^-1 e
    | 0    E_B  G_B |
    | H_A  H_B  N_J |
"""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

from .compile import inner, kernel
from .spec import Spec
from .vectors import Vec3, cross, dot, length, minus, plus, plus_scaled, scaled

# The most that one step of Newton's changes how far a body turns [rad].
TURN = 0.5


class Mat3(NamedTuple):
    """A matrix by its columns."""

    x: Vec3
    y: Vec3
    z: Vec3


class TurnEquation(NamedTuple):
    """What one end's body has to fulfil: its equation and the derivatives."""

    e: Vec3
    e_w: Mat3  # by omega
    e_j: Mat3  # by J
    r_w: Mat3  # r_m by omega
    arm: Vec3  # r_m


@inner
def times(m, v):
    """Return m v."""
    return plus_scaled(plus_scaled(scaled(v.x, m.x), v.y, m.y), v.z, m.z)


@inner
def product(m, n):
    """Return m n."""
    return Mat3(times(m, n.x), times(m, n.y), times(m, n.z))


@inner
def sum_of(m, s, n):
    """Return m + s n."""
    return Mat3(plus_scaled(m.x, s, n.x), plus_scaled(m.y, s, n.y), plus_scaled(m.z, s, n.z))


@inner
def crossing(s, a):
    """Return s [a], the matrix of s a x."""
    return Mat3(
        Vec3(0.0, s * a.z, -s * a.y), Vec3(-s * a.z, 0.0, s * a.x), Vec3(s * a.y, -s * a.x, 0.0)
    )


@inner
def outer(a, b):
    """Return a b^T."""
    return Mat3(scaled(b.x, a), scaled(b.y, a), scaled(b.z, a))


@inner
def diagonal(s):
    """Return s times the identity."""
    return Mat3(Vec3(s, 0.0, 0.0), Vec3(0.0, s, 0.0), Vec3(0.0, 0.0, s))


@inner
def solution(m, b):
    """Return x of m x = b by Cramer's rule; 0 where m is singular."""
    yz = cross(m.y, m.z)
    det = dot(m.x, yz)
    scale = 1.0 / det if det != 0.0 else 0.0
    return Vec3(
        scale * dot(b, yz), scale * dot(b, cross(m.z, m.x)), scale * dot(b, cross(m.x, m.y))
    )


@inner
def solutions(m, n):
    """Return X of m X = n."""
    return Mat3(solution(m, n.x), solution(m, n.y), solution(m, n.z))


def make_mean_lever(spec: Spec) -> Any:
    """Return `kernel(r, a) -> (r_m, derivative by a)` of Cayley's turn, a = omega dt/2."""

    def mean_lever(r, a):
        s = 1.0 / (1.0 + dot(a, a))
        arm = scaled(s, plus(plus(r, cross(a, r)), scaled(dot(a, r), a)))
        by_a = sum_of(sum_of(crossing(-s, r), s, outer(a, r)), s * dot(a, r), diagonal(1.0))
        return arm, sum_of(by_a, -2.0 * s, outer(arm, a))

    return kernel(mean_lever, spec)


def make_moment(spec: Spec) -> Any:
    """Return `kernel(body, v, m, lever, dt) -> TurnEquation`; v.w with the impulses so far.

    lever: r of the spring, its impulse J on A, and 1 for A, -1 for B.
    """
    from .rotation import inertia_times, is_round

    mean_lever: Any = make_mean_lever(spec)

    def inertia(body, v):
        x, y, z = inertia_times(body, v.x, v.y, v.z)
        return Vec3(x, y, z)

    inertia = kernel(inertia, spec)

    def moment(body, v, m, lever, dt):
        r, j, sign = lever
        w = Vec3(body.turn_x, body.turn_y, body.turn_z)
        arm, by_a = mean_lever(r, scaled(0.5 * dt, w))
        by_w = Mat3(scaled(0.5 * dt, by_a.x), scaled(0.5 * dt, by_a.y), scaled(0.5 * dt, by_a.z))
        nothing = diagonal(0.0)
        if body.sprung == 0:  # it turns by the mean of given spins
            return TurnEquation(Vec3(0.0, 0.0, 0.0), diagonal(1.0), nothing, by_w, arm)
        start = Vec3(m.wx, m.wy, m.wz)
        half = scaled(0.5, inertia(body, minus(Vec3(v.wx, v.wy, v.wz), start)))
        had = inertia(body, w)
        e = minus(minus(had, inertia(body, start)), half)
        i = Mat3(
            inertia(body, Vec3(1.0, 0.0, 0.0)),
            inertia(body, Vec3(0.0, 1.0, 0.0)),
            inertia(body, Vec3(0.0, 0.0, 1.0)),
        )
        e_w, e_l = i, diagonal(-0.5)
        if not is_round(body):
            e = plus_scaled(e, 0.5 * dt, cross(w, plus(had, half)))
            turned = sum_of(product(crossing(1.0, w), i), -1.0, crossing(1.0, plus(had, half)))
            e_w = sum_of(e_w, 0.5 * dt, turned)
            e_l = sum_of(e_l, 0.25 * dt, crossing(1.0, w))
        # L = sign r_m x J
        e_w = sum_of(e_w, -sign, product(e_l, product(crossing(1.0, j), by_w)))
        return TurnEquation(e, e_w, product(e_l, crossing(sign, arm)), by_w, arm)

    return kernel(moment, spec)


def make_newton_step(spec: Spec, place: Any, law: Any, push: Any) -> Any:
    """Return `kernel(link, bodies, velocities, motion, dt) -> (change, size)` of an impulse.

    law: kernel of a spring's force and of its slope by the length; push: kernel that gives impulses
    to a body. To the change counts by how far bodies turn, as a share of the impulse.
    """
    moment: Any = make_moment(spec)
    mean_lever: Any = make_mean_lever(spec)

    def twist(body, v, lever, old, dt):
        # The spring's angular impulse by the mean spin as it is now.
        r, j, sign = lever
        w = Vec3(body.turn_x, body.turn_y, body.turn_z)
        arm, _ = mean_lever(r, scaled(0.5 * dt, w))
        spun = cross(arm, scaled(sign, j))
        push(body, v, Vec3(0.0, 0.0, 0.0), minus(spun, old))
        return spun

    twist = kernel(twist, spec)

    def twist_both(link, bodies, velocities, start, dt):
        a, b = link.a, link.b
        j = Vec3(link.px, link.py, link.pz)
        old = Vec3(link.lax, link.lay, link.laz)
        link.lax, link.lay, link.laz = twist(bodies[a], velocities[a], (start.r_a, j, 1.0), old, dt)
        old = Vec3(-link.lbx, -link.lby, -link.lbz)
        on_b = twist(bodies[b], velocities[b], (start.r_b, j, -1.0), old, dt)
        link.lbx, link.lby, link.lbz = -on_b.x, -on_b.y, -on_b.z

    twist_both = kernel(twist_both, spec)

    def gain(body, change):
        body.turn_x += change.x
        body.turn_y += change.y
        body.turn_z += change.z

    gain = kernel(gain, spec)

    def newton_step(link, bodies, velocities, motion, dt):
        body_a, body_b = bodies[link.a], bodies[link.b]
        va, vb, ma, mb = velocities[link.a], velocities[link.b], motion[link.a], motion[link.b]
        start = place(link, body_a, body_b)
        twist_both(link, bodies, velocities, start, dt)
        j = Vec3(link.px, link.py, link.pz)
        a = moment(body_a, va, ma, (start.r_a, j, 1.0), dt)
        b = moment(body_b, vb, mb, (start.r_b, j, -1.0), dt)
        between = Vec3(body_b.x - body_a.x, body_b.y - body_a.y, body_b.z - body_a.z)
        before = minus(plus(between, start.r_b), start.r_a)
        moved = Vec3(
            mb.vx + vb.vx - ma.vx - va.vx,
            mb.vy + vb.vy - ma.vy - va.vy,
            mb.vz + vb.vz - ma.vz - va.vz,
        )
        middle = minus(plus(plus(between, scaled(0.25 * dt, moved)), b.arm), a.arm)
        end = minus(scaled(2.0, middle), before)
        length_0, length_1 = start.length, length(end)
        both = length_0 + length_1
        if both == 0.0 or length_1 == 0.0:
            return 0.0, 0.0
        force, slope = law(link, bodies, motion, start, length_1, dt)
        pull = 2.0 * dt * force / both
        n = minus(j, scaled(pull, middle))
        # The derivative of dt F u by X.
        share = 2.0 * (2.0 * dt * slope - pull) / (both * length_1)
        n_x = sum_of(diagonal(pull), share, outer(middle, end))
        n_j = sum_of(diagonal(1.0), 0.25 * dt * (body_a.inv_m + body_b.inv_m), n_x)
        h_a, h_b = product(n_x, a.r_w), product(n_x, b.r_w)  # of N by omega: H_A, -H_B
        n_j = sum_of(n_j, -1.0, product(h_a, solutions(a.e_w, a.e_j)))
        n_j = sum_of(n_j, 1.0, product(h_b, solutions(b.e_w, b.e_j)))
        right = minus(times(h_a, solution(a.e_w, a.e)), times(h_b, solution(b.e_w, b.e)))
        change = solution(n_j, minus(right, n))
        turn_a = scaled(-1.0, solution(a.e_w, plus(a.e, times(a.e_j, change))))
        turn_b = scaled(-1.0, solution(b.e_w, plus(b.e, times(b.e_j, change))))
        angle = dt * sqrt(max(dot(turn_a, turn_a), dot(turn_b, turn_b)))
        part = 1.0 if angle <= TURN else TURN / angle
        change, new = scaled(part, change), plus_scaled(j, part, change)
        gain(body_a, scaled(part, turn_a))
        gain(body_b, scaled(part, turn_b))
        link.force, link.px, link.py, link.pz = force, new.x, new.y, new.z
        push(body_a, va, change, Vec3(0.0, 0.0, 0.0))
        push(body_b, vb, scaled(-1.0, change), Vec3(0.0, 0.0, 0.0))
        twist_both(link, bodies, velocities, start, dt)
        return length(change) + angle * length(new), length(new)

    return kernel(newton_step, spec)
