"""How fast surfaces approach or part in free motion (`records.MOTION`), and what is no approach.

v > 0: they part. Speeds are those of the bodies to each other: no observer changes what meets.
"""

from __future__ import annotations

from typing import Any

from .compile import inner, kernel
from .records import PLANE
from .spec import Spec
from .vectors import Vec3, dot, length, minus, position

NEVER = 1e300  # [s]
# When a contact is due: by the rate of its own gap; a guess for any feature of its pair; found on
# the shapes; not in this step; or now.
GUESSED, ELSEWHERE, LOCATED, FAR, MEETS = 0, 1, 2, 3, 4
# Slowest approach [m/s], and as a share of the bodies' speed to each other: what solves leave.
CREEP, ROUND_OFF = 1e-7, 1e-9


@inner
def normal(contact):
    """Return the normal of a row, from A to B."""
    return Vec3(contact.nx, contact.ny, contact.nz)


@inner
def relative_velocity(ma, mb):
    """Return the velocity of B's centre from A's [m/s]; ma, mb: rows of `motion`."""
    return minus(Vec3(mb.vx, mb.vy, mb.vz), Vec3(ma.vx, ma.vy, ma.vz))


@inner
def gained(m):
    """Return what forces change of a body's velocity in the part [m/s]; m: its row of `motion`."""
    return Vec3(m.dvx, m.dvy, m.dvz)


def make_rate(spec: Spec) -> Any:
    """Return `kernel(n, ma, mb, arm_a, arm_b) -> v`: of a point of B from one of A, along n [m/s].

    ma, mb: rows of `motion`; arm_a, arm_b: the points, from the centres of their bodies.
    """
    turns = spec.has("rotation")

    def rate(n, ma, mb, arm_a, arm_b):
        v = dot(n, relative_velocity(ma, mb))
        if turns:
            v += n.x * (mb.wy * arm_b.z - mb.wz * arm_b.y)
            v += n.y * (mb.wz * arm_b.x - mb.wx * arm_b.z)
            v += n.z * (mb.wx * arm_b.y - mb.wy * arm_b.x)
            v -= n.x * (ma.wy * arm_a.z - ma.wz * arm_a.y)
            v -= n.y * (ma.wz * arm_a.x - ma.wx * arm_a.z)
            v -= n.z * (ma.wx * arm_a.y - ma.wy * arm_a.x)
        return v

    return kernel(rate, spec)


def make_approach(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> v`: rate of its gap as the part begins [m/s]."""
    rate = make_rate(spec)

    def approach(contact, bodies, motion):
        at = position(contact)
        arm_a = minus(at, position(bodies[contact.a]))
        arm_b = minus(at, position(bodies[contact.b]))
        return rate(normal(contact), motion[contact.a], motion[contact.b], arm_a, arm_b)

    return kernel(approach, spec)


def make_forced(spec: Spec) -> Any:
    """Return `kernel(contact, motion) -> (dv, most)`: what forces change of v in the part [m/s].

    dv: of both bodies in free flight; most: where contacts hold the one body and not the other.
    """

    def forced(contact, motion):
        n, of_a, of_b = normal(contact), gained(motion[contact.a]), gained(motion[contact.b])
        return dot(n, minus(of_b, of_a)), abs(dot(n, of_a)) + abs(dot(n, of_b))

    return kernel(forced, spec)


def make_turning(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> speed`, at most, by the spins of both [m/s]."""
    turns = spec.has("rotation")

    def turning_of(contact, body, m):
        # A plane has no size: its spin moves what is at the contact.
        size = body.bound
        if body.shape == PLANE:
            size = length(minus(position(contact), position(body)))
        return size * length(Vec3(m.wx, m.wy, m.wz))

    turning_of = kernel(turning_of, spec)

    def turning(contact, bodies, motion):
        speed = 0.0
        if turns:
            speed += turning_of(contact, bodies[contact.a], motion[contact.a])
            speed += turning_of(contact, bodies[contact.b], motion[contact.b])
        return speed

    return kernel(turning, spec)


def make_nearest_rate(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> v`: least rate of any gap along the normal [m/s].

    Bodies that n separates by phi are apart for as long as phi + v t > 0, whatever turns.
    """
    turning = make_turning(spec)

    def nearest_rate(contact, bodies, motion):
        v = relative_velocity(motion[contact.a], motion[contact.b])
        return dot(normal(contact), v) - turning(contact, bodies, motion)

    return kernel(nearest_rate, spec)


def make_relative_speed(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> speed`: at most, of points of its bodies [m/s]."""
    turning = make_turning(spec)

    def relative_speed(contact, bodies, motion):
        v = relative_velocity(motion[contact.a], motion[contact.b])
        return length(v) + turning(contact, bodies, motion)

    return kernel(relative_speed, spec)


def make_slowest(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> speed` up to which its surfaces do not move."""
    relative_speed = make_relative_speed(spec)

    def slowest(contact, bodies, motion):
        return CREEP + ROUND_OFF * relative_speed(contact, bodies, motion)

    return kernel(slowest, spec)
