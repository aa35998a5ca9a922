"""How the points of joints move as their bodies turn in a step: by chords, to the last digit.

The turn is the Cayley map (`rotation`): by the mean spin w of a step a body moves its point r by
    r_1 - r_0 = dt w x (r_0 + r_1)/2,   (r_0 + r_1)/2 = (u . r) u + cos(theta/2) (r - (u . r) u),
r as it is half way, theta the angle and u the unit axis of the turn. With these levers a row at the
middle asks that the points of both bodies move alike, not that they begin to: nothing is left to
project, which would do work. Both bodies then have their impulse at one point, the mean of where
the joint is, so that energy, momentum and angular momentum are kept at once.
A row of the start has the levers of the start; what it leaves is projected back in the same step:
    r_1 - r_0 - f x r_0 = (f x r_0 + f x (f x r_0)/2)/(1 + |f|^2/4) - f x r_0,    f = dt w

A row of ends that slide, its n of A's own frame, asks that n . e stays, e from A's centre to B's:
    n_1 . e_1 - n_0 . e_0 = m . (e_1 - e_0) + (n_1 - n_0) . (e_0 + e_1)/2,    m = (n_0 + n_1)/2
                          = m . (e_1 - e_0 - dt w_A x (e_0 + e_1)/2)
so that with m for its normal, and with the mean of e for the lever of A, it is kept to the last
digit as well, wherever along A its ends have slid to.
"""

from __future__ import annotations

from typing import Any

from .collide.joint import couple_of, free_along, is_couple, is_sliding
from .collide.records import put_arms, put_normal
from .compile import inner, kernel
from .integrate import LASTING
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, position, scaled


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


@inner
def put_mean_ends(contact, kind, end_a, end_b, bodies, poses):
    """Fill levers and direction of a joint's row: their means over the turns of its bodies.

    end_a, end_b: its ends half way, as bodies are; poses: rows of the bodies at the start.
    """
    a, b = bodies[contact.a], bodies[contact.b]
    if is_couple(kind):
        put_arms(contact, couple_of(end_a), couple_of(end_a))
        return
    arm_a = mean_lever(a, poses[contact.a], minus(position(end_a), position(a)))
    arm_b = mean_lever(b, poses[contact.b], minus(position(end_b), position(b)))
    if is_sliding(kind):
        n = mean_lever(a, poses[contact.a], Vec3(contact.nx, contact.ny, contact.nz))
        put_normal(contact, scaled(1.0 / length(n), n))
        arm_a = minus(plus(position(b), arm_b), position(a))
    put_arms(contact, arm_a, arm_b)
    free = free_along(kind, end_a)
    contact.free_x, contact.free_y, contact.free_z = free.x, free.y, free.z


def make_joint_velocity(spec: Spec) -> Any:
    """Return `kernel(contact, va, vb) -> Vec3`: of B's end from A's, less where it slides [m/s]."""
    turns = row_terms(spec).levers

    def joint_velocity(contact, va, vb):
        v = minus(Vec3(vb.vx, vb.vy, vb.vz), Vec3(va.vx, va.vy, va.vz))
        if turns:
            arm_a = Vec3(contact.arm_ax, contact.arm_ay, contact.arm_az)
            arm_b = Vec3(contact.arm_bx, contact.arm_by, contact.arm_bz)
            v = plus(v, cross(Vec3(vb.wx, vb.wy, vb.wz), arm_b))
            v = minus(v, cross(Vec3(va.wx, va.wy, va.wz), arm_a))
            free = Vec3(contact.free_x, contact.free_y, contact.free_z)
            v = minus(v, scaled(dot(free, v), free))
        return v

    return kernel(joint_velocity, spec)


@inner
def turned_by(f, r):
    """Return r_1 - r, r turned by the spin f/dt for dt."""
    moved = cross(f, r)
    return scaled(1.0 / (1.0 + 0.25 * dot(f, f)), plus(moved, scaled(0.5, cross(f, moved))))


@inner
def _left_by_direction(n, f, e, moved):
    """Return (n_1 - n) . (e + moved) - (f x n) . e; n turns with A, by f.

    moved: displacement of B's end from A's.
    """
    turned = turned_by(f, n)
    return dot(minus(turned, cross(f, n)), e) + dot(turned, moved)


def make_turned_apart(spec: Spec) -> Any:
    """Return `kernel(contact, velocities, motion, dt) -> how far` along a row of the start [m].

    Of a row that is solved. 0 of rows at the middle, and of bodies with an impact within the step.
    """
    turns, keeps = row_terms(spec).levers, step_terms(spec).centred

    def turn_of(v, m, dt):
        w = Vec3(v.wx, v.wy, v.wz)
        if keeps:
            if m.carried == LASTING:
                w = scaled(0.5, plus(w, Vec3(m.wx, m.wy, m.wz)))
        return scaled(dt, w)

    turn_of = kernel(turn_of, spec)

    def displacement_of(v, m, dt):
        u = Vec3(v.vx, v.vy, v.vz)
        if keeps:
            if m.carried == LASTING:
                u = scaled(0.5, plus(u, Vec3(m.vx, m.vy, m.vz)))
        return scaled(dt, u)

    displacement_of = kernel(displacement_of, spec)

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
        va, vb, ma, mb = velocities[a], velocities[b], motion[a], motion[b]
        n = Vec3(contact.nx, contact.ny, contact.nz)
        f = turn_of(vb, mb, dt)
        turned = turned_by(f, arm_b)
        of_b = minus(turned, cross(f, arm_b))
        if contact.sliding == 1:
            moved = plus(minus(displacement_of(vb, mb, dt), displacement_of(va, ma, dt)), turned)
            return _left_by_direction(n, turn_of(va, ma, dt), arm_a, moved) + dot(n, of_b)
        f = turn_of(va, ma, dt)
        of_a = minus(turned_by(f, arm_a), cross(f, arm_a))
        return dot(n, minus(of_b, of_a))

    return kernel(turned_apart, spec)
