"""Approach speeds of surfaces in free motion (`records.MOTION`), and which are too slow to count.

v > 0: they part. Speeds are those of the bodies to each other: no observer changes what meets.
"""

from __future__ import annotations

from typing import Any

from .collide.nearest_image import place_beside
from .collide.shapes import has_drum
from .compile import inner, kernel
from .effects import made_once
from .records import DRUM, PLANE, TOUCHING
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, cross, dot, length, minus, plus, position, scaled

NEVER = 1e300  # [s]
# When a contact is due: by the rate of its own gap; a guess for any feature of its pair; found on
# the shapes; not in this step; or now.
GUESSED, ELSEWHERE, LOCATED, FAR, MEETS = 0, 1, 2, 3, 4
# Slowest approach [m/s], and as a share of the bodies' speed to each other: what solves leave.
CREEP, ROUND_OFF = 1e-7, 1e-9
# Bodies that overlap by more are moved apart first: what they do has no order in time [m].
OVERLAP = 5e-5
# What turns over an edge by an angle a in a step leaves that as deep as this share of a^3 times the
# bodies' size: a turn by the mean velocity cuts an arc short by up to a^3/12 of its arm, and the
# projection leaves 1/0.2 of it, by default. Nothing overlaps there.
CUT_SHORT = 0.5
# Shares of a step that are too short to tell an acceleration.
SHORT = 1e-6


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


@inner
def ahead(m):
    """Return what is reckoned to change of a body's velocity in the part [m/s]; m: its row."""
    return Vec3(m.ahead_x, m.ahead_y, m.ahead_z)


def make_expect(spec: Spec) -> Any:
    """Return `kernel(contacts, count, bodies, motion, left)`: what changes velocities ahead.

    Forces do, of what is free. What touches and neither approaches nor parts is kept from it by its
    contacts: it is reckoned to accelerate as in the last part of a step.
    """
    slowest, bilateral = make_slowest(spec), row_terms(spec).bilateral

    def hold(body, m, left):
        if body.inv_m > 0.0 and (m.dvx != 0.0 or m.dvy != 0.0 or m.dvz != 0.0):
            m.ahead_x, m.ahead_y, m.ahead_z = body.ax * left, body.ay * left, body.az * left

    hold = kernel(hold, spec)

    def expect(contacts, count, bodies, motion, left):
        for i in range(motion.shape[0]):
            m = motion[i]
            m.ahead_x, m.ahead_y, m.ahead_z = m.dvx, m.dvy, m.dvz
        for c in range(count):
            contact = contacts[c]
            touches = contact.phi <= TOUCHING
            if bilateral:
                touches = touches or contact.bilateral == 1
            if touches:
                if abs(contact.rate) <= slowest(contact, bodies, motion):
                    hold(bodies[contact.a], motion[contact.a], left)
                    hold(bodies[contact.b], motion[contact.b], left)

    return kernel(expect, spec)


def make_note_acceleration(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, motion, params)`, once a part of some length is solved."""

    noted, note_rate = made_once(spec, "note_rate")
    kinematic = step_terms(spec).kinematic

    def note_acceleration(bodies, velocities, motion, params):
        if params.dt < SHORT * params.timestep:
            return
        for i in range(motion.shape[0]):
            body, v, m = bodies[i], velocities[i], motion[i]
            moves = body.inv_m > 0.0
            if kinematic:
                moves = moves or body.kinematic == 1
            if not moves:
                continue
            body.ax = (v.vx - m.vx) / params.dt
            body.ay = (v.vy - m.vy) / params.dt
            body.az = (v.vz - m.vz) / params.dt
            if noted:
                note_rate(body, v, m, params.dt)

    return kernel(note_acceleration, spec)


def make_change_ahead(spec: Spec) -> Any:
    """Return `kernel(contact, motion) -> change` of v that is reckoned with in the part [m/s]."""

    def change_ahead(contact, motion):
        return dot(normal(contact), minus(ahead(motion[contact.b]), ahead(motion[contact.a])))

    return kernel(change_ahead, spec)


def make_rate(spec: Spec) -> Any:
    """Return `kernel(n, ma, mb, arm_a, arm_b) -> v`: of a point of B from one of A, along n [m/s].

    ma, mb: rows of `motion`; arm_a, arm_b: the points, from the centres of their bodies.
    """
    turns = step_terms(spec).turns

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
    rate, swept, beside = make_rate(spec), row_terms(spec).swept, place_beside(spec)

    def approach(contact, bodies, motion):
        at = position(contact)
        arm_a = minus(at, position(bodies[contact.a]))
        arm_b = minus(at, beside(bodies[contact.a], bodies[contact.b]))
        if swept:  # it is where B will be across n
            aside = Vec3(contact.tangential_x, contact.tangential_y, contact.tangential_z)
            arm_b = minus(arm_b, aside)
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
    turns, drums = step_terms(spec).turns, has_drum(spec)

    def turning_of(contact, body, m):
        # A plane has no size, a drum no end: its spin moves what is at the contact.
        size = body.bound
        if body.shape == PLANE:
            size = length(minus(position(contact), position(body)))
        if drums:
            if body.shape == DRUM:
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


def make_depth(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion, params) -> depth` from which bodies overlap [m]."""
    turns = step_terms(spec).turns

    def depth(contact, bodies, motion, params):
        deepest = OVERLAP
        if turns:
            one, other, size = bodies[contact.a], bodies[contact.b], 0.0
            if one.shape != PLANE:
                size = one.bound
            if other.shape != PLANE:
                size = min(size, other.bound) if one.shape != PLANE else other.bound
            ma, mb = motion[contact.a], motion[contact.b]
            angle = length(minus(Vec3(mb.wx, mb.wy, mb.wz), Vec3(ma.wx, ma.wy, ma.wz)))
            angle *= params.timestep
            deepest = max(deepest, CUT_SHORT * size * angle * angle * angle)
        return deepest

    return kernel(depth, spec)


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


def make_is_still(spec: Spec) -> Any:
    """Return `kernel(bodies, motion) -> whether` no two surfaces can be found to move."""
    turns, drums = step_terms(spec).turns, has_drum(spec)

    def is_still(bodies, motion):
        for i in range(motion.shape[0]):
            m = motion[i]
            squared = m.vx * m.vx + m.vy * m.vy + m.vz * m.vz
            if turns:
                spin = m.wx * m.wx + m.wy * m.wy + m.wz * m.wz
                endless = bodies[i].shape == PLANE
                if drums:
                    endless = endless or bodies[i].shape == DRUM
                if endless:
                    if spin > 0.0:
                        return False
                else:
                    squared += bodies[i].bound * bodies[i].bound * spin
            # Speeds of both bodies and of both their spins add up.
            if not squared <= CREEP * CREEP / 16.0:
                return False
        return True

    return kernel(is_still, spec)


def make_gap_acceleration(spec: Spec) -> Any:
    """Return `kernel(contact, bodies, motion) -> a` of its gap, at most, with free motion [m/s^2].

    A normal turns with its bodies, and as they go round each other.
    """
    relative_speed, turns = make_relative_speed(spec), step_terms(spec).turns
    ropes = row_terms(spec).taut

    def gap_acceleration(contact, bodies, motion):
        ma, mb = motion[contact.a], motion[contact.b]
        one, other, rate = bodies[contact.a], bodies[contact.b], 0.0
        if one.shape != PLANE and other.shape != PLANE:
            rate = length(relative_velocity(ma, mb)) / min(one.bound, other.bound)
        if ropes:
            if contact.span > 0.0:
                rate = max(rate, length(relative_velocity(ma, mb)) / contact.span)
        if turns:
            rate += length(Vec3(ma.wx, ma.wy, ma.wz)) + length(Vec3(mb.wx, mb.wy, mb.wz))
        return rate * relative_speed(contact, bodies, motion)

    return kernel(gap_acceleration, spec)


def make_gap_acceleration_of_rope(spec: Spec) -> Any:
    """Return `kernel(end_a, end_b, bodies, motion) -> a` of its gap in free motion [m/s^2].

    phi'' = -|d|'',  |d|'' = (|d'|^2 - (d'.u)^2)/|d| + u . (w_B x (w_B x r_B) - w_A x (w_A x r_A)),
    u = d/|d|, beside what forces do: ends that pass each other go apart as they pass.
    """
    turns = step_terms(spec).turns

    def acceleration_of_rope(end_a, end_b, bodies, motion):
        ma, mb = motion[end_a.owner], motion[end_b.owner]
        d, v = minus(position(end_b), position(end_a)), relative_velocity(ma, mb)
        size = length(d)
        if size == 0.0:
            return 0.0
        u = scaled(1.0 / size, d)
        acceleration = 0.0
        if turns:
            wa, wb = Vec3(ma.wx, ma.wy, ma.wz), Vec3(mb.wx, mb.wy, mb.wz)
            turn_a = cross(wa, minus(position(end_a), position(bodies[end_a.owner])))
            turn_b = cross(wb, minus(position(end_b), position(bodies[end_b.owner])))
            v = plus(v, minus(turn_b, turn_a))
            acceleration = dot(u, minus(cross(wb, turn_b), cross(wa, turn_a)))
        along = dot(u, v)
        return -acceleration - (dot(v, v) - along * along) / size

    return kernel(acceleration_of_rope, spec)
