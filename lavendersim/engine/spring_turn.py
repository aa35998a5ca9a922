"""The turn of a body that springs twist: what their torque gives in energy is its work, exactly.

Implicit midpoint on the body's momentum P = I omega, in body axes, with the angular impulse L of
the step (G_0 = R_0^T L) and Cayley's turn C by the mean spin (Simo and Wong 1991):
    m = P_0 + G_0/2 + dt/2 (m + G_0/2) x I^-1 m,    P_1 = 2 m - P_0,    R_1 = R_0 C,  C: I^-1 m dt
so R_1 P_1 = R_0 P_0 + L, and as C leaves I^-1 m as it is,
    (P_1 . I^-1 P_1 - P_0 . I^-1 P_0)/2 = (P_1 - P_0) . I^-1 m = G_0 . I^-1 m.
For L = r_m x J, of levers r_m = (r_0 + r_1)/2, that is J . (r_1 - r_0)/dt. A round body turns by
the mean of its spins, of which the same holds. m is found by Newton's method, from the last one.
"""

from __future__ import annotations

from typing import Any

from .compile import kernel
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, from_body, into_body, minus, plus, scaled

PASSES = 20
# Relative change of m, squared, at which its digits are found.
FOUND = 1e-28
# BODY.sprung: what springs do to its turn.
TWISTED = 1  # they act off its centre
PLACED = 2  # they say where it goes: `spring_limit`
BOTH = 3  # and contacts with them: `spring_contacts`


def make_mean_spin(spec: Spec) -> Any:
    """Return `kernel(body, v, m, dt) -> found`: the step's mean spin, `body.turn_x` and so on.

    body: as the step begins, with a mean spin to begin from, world; v.w: its spin after impulses,
    by the inertia it begins with; m.w: its spin before them.
    """
    uneven = step_terms(spec).uneven

    def product(body, p, q):
        # p x I^-1 q, body axes.
        return cross(p, Vec3(body.inv_ix * q.x, body.inv_iy * q.y, body.inv_iz * q.z))

    product = kernel(product, spec)

    def newton_step(body, half, p, g, m):
        # Solves (1 - half ([p + g] D - [D m])) dm = f, p = m, D = I^-1, by Cramer's rule.
        q = plus(m, g)
        f = minus(plus(plus(p, g), scaled(half, product(body, q, m))), m)
        a, b, c = half * body.inv_ix, half * body.inv_iy, half * body.inv_iz
        x = Vec3(1.0, -a * q.z, a * q.y)
        y = Vec3(b * q.z, 1.0, -b * q.x)
        z = Vec3(-c * q.y, c * q.x, 1.0)
        # + half [D m] x: its columns.
        x = plus(x, Vec3(0.0, c * m.z, -b * m.y))
        y = plus(y, Vec3(-c * m.z, 0.0, a * m.x))
        z = plus(z, Vec3(b * m.y, -a * m.x, 0.0))
        yz = cross(y, z)
        scale = dot(x, yz)
        if scale == 0.0:
            return Vec3(0.0, 0.0, 0.0), False
        scale = 1.0 / scale
        found = Vec3(scale * dot(f, yz), scale * dot(f, cross(z, x)), scale * dot(f, cross(x, y)))
        return found, True

    newton_step = kernel(newton_step, spec)

    def mean_spin(body, v, m, dt):
        if uneven and not (body.inv_ix == body.inv_iy and body.inv_iy == body.inv_iz):
            ix, iy, iz = body.inv_ix, body.inv_iy, body.inv_iz
            p = into_body(body, Vec3(m.wx, m.wy, m.wz))
            p = Vec3(p.x / ix, p.y / iy, p.z / iz)
            g = into_body(body, Vec3(v.wx - m.wx, v.wy - m.wy, v.wz - m.wz))
            g = Vec3(0.5 * g.x / ix, 0.5 * g.y / iy, 0.5 * g.z / iz)
            q = into_body(body, Vec3(body.turn_x, body.turn_y, body.turn_z))
            q = Vec3(q.x / ix, q.y / iy, q.z / iz)
            for number in range(2 * PASSES):
                if number == PASSES:  # not from the last one: from that of a short step
                    q = plus(p, g)
                change, regular = newton_step(body, 0.5 * dt, p, g, q)
                q = plus(q, change)
                if regular and dot(change, change) <= FOUND * dot(q, q):
                    w = from_body(body, Vec3(ix * q.x, iy * q.y, iz * q.z))
                    body.turn_x, body.turn_y, body.turn_z = w.x, w.y, w.z
                    return True
            return False
        body.turn_x, body.turn_y = 0.5 * (m.wx + v.wx), 0.5 * (m.wy + v.wy)
        body.turn_z = 0.5 * (m.wz + v.wz)
        return True

    return kernel(mean_spin, spec)


def make_twist(spec: Spec) -> Any:
    """Return `kernel(body, v, dt)`: turn a body by its mean spin; v.w: as in `make_mean_spin`."""
    from .rotation import inertia_times, inverse_inertia_times, turn

    def twist(body, v, dt):
        # The world's angular momentum is what impulses made it.
        x, y, z = inertia_times(body, v.wx, v.wy, v.wz)
        turn(body, dt * body.turn_x, dt * body.turn_y, dt * body.turn_z)
        v.wx, v.wy, v.wz = inverse_inertia_times(body, x, y, z)

    return kernel(twist, spec)
