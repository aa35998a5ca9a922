"""How the points of joints move as their bodies turn in a step: by chords, to the last digit.

The turn is the Cayley map (`rotation`): by the mean spin w of a step a body moves its point r by
    r_1 - r_0 = dt w x (r_0 + r_1)/2,   (r_0 + r_1)/2 = (u . r) u + cos(theta/2) (r - (u . r) u),
r as it is half way, theta the angle and u the unit axis of the turn. With these levers a row at the
middle asks that the points of both bodies move alike, not that they begin to: nothing is left to
project, which would do work. Both bodies then have their impulse at one point, the mean of where
the joint is, so that energy, momentum and angular momentum are kept at once.
A row of the start has the levers of the start; what it leaves is projected back in the same step:
    r_1 - r_0 - f x r_0 = (f x r_0 + f x (f x r_0)/2)/(1 + |f|^2/4) - f x r_0,    f = dt w
"""

from __future__ import annotations

from typing import Any

from .compile import inner, kernel
from .integrate import LASTING
from .row_terms import row_terms
from .spec import Spec
from .vectors import Vec3, cross, dot, minus, plus, scaled


@inner
def mean_lever(body, start, r):
    """Return (r_0 + r_1)/2; body: half way through its turn, start: as it begins; r: half way."""
    # Of the turn from the start to the middle: q q_0^-1, its vector sin(theta/4) u.
    w, x, y, z = start.qw, -start.qx, -start.qy, -start.qz
    a, b, c, d = body.qw, body.qx, body.qy, body.qz
    v = Vec3(
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )
    # cos(theta/2) = 1 - 2 |v|^2, and the part along u is (v . r) v/|v|^2.
    return plus(scaled(1.0 - 2.0 * dot(v, v), r), scaled(2.0 * dot(v, r), v))


def make_joint_velocity(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb) -> Vec3`: of B's point of the joint from A's [m/s]."""
    turns = row_terms(spec).levers

    def joint_velocity(contact, va, vb):
        v = minus(Vec3(vb.vx, vb.vy, vb.vz), Vec3(va.vx, va.vy, va.vz))
        if turns:
            arm_a = Vec3(contact.arm_ax, contact.arm_ay, contact.arm_az)
            arm_b = Vec3(contact.arm_bx, contact.arm_by, contact.arm_bz)
            v = plus(v, cross(Vec3(vb.wx, vb.wy, vb.wz), arm_b))
            v = minus(v, cross(Vec3(va.wx, va.wy, va.wz), arm_a))
        return v

    return kernel(joint_velocity, spec)


def make_turned_apart(spec: Spec) -> Any:
    """Return `kernel(contact, velocities, motion, dt) -> how far` along a row of the start [m].

    Of a row that is solved. 0 of rows at the middle, and of bodies with an impact within the step.
    """
    turns, keeps = row_terms(spec).levers, spec.has("contact_midpoint")

    def beyond(r, v, m, dt):
        w = Vec3(v.wx, v.wy, v.wz)
        if keeps:
            if m.carried == LASTING:
                w = scaled(0.5, plus(w, Vec3(m.wx, m.wy, m.wz)))
        f = scaled(dt, w)
        moved = cross(f, r)
        turned = scaled(1.0 / (1.0 + 0.25 * dot(f, f)), plus(moved, scaled(0.5, cross(f, moved))))
        return minus(turned, moved)

    beyond = kernel(beyond, spec)

    def turned_apart(contact, velocities, motion, dt):
        if not turns:
            return 0.0
        a, b = contact.a, contact.b
        if keeps:
            if motion[a].midway == 1 and motion[b].midway == 1 and contact.lasts == 1:
                return 0.0
            if motion[a].tau < dt or motion[b].tau < dt:
                return 0.0
        arm_a = Vec3(contact.arm_ax, contact.arm_ay, contact.arm_az)
        arm_b = Vec3(contact.arm_bx, contact.arm_by, contact.arm_bz)
        of_a = beyond(arm_a, velocities[a], motion[a], dt)
        of_b = beyond(arm_b, velocities[b], motion[b], dt)
        return dot(Vec3(contact.nx, contact.ny, contact.nz), minus(of_b, of_a))

    return kernel(turned_apart, spec)
