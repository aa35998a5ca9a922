"""Error estimate of step doubling: a substep whole and in halves, compared (`error_control`).

    e = max over bodies of max(dx/L, dv/U)/3
    dx = |x - x'| + R theta       farthest that a point of the body is off [m]
    dv = |v - v'| + R |w - w'|    and its velocity [m/s]
    U = fastest speed of a point of it so far, at least R/T
    L = path length of the run, if it goes on at that speed; at least R
R: radius about the centre of mass that holds the body, T: duration of the run. What solves leave is
no error of the timestep: below NOISE times their residual dv says nothing.

At the end of a step a velocity violates its contacts by O(dt^2), because they hold at the middle;
the next step begins with it and does not add to it. So dv is taken without the part that contacts
would take away: with J (dv + M^-1 J^T p) = 0 of all rows that push or hold, and of tangents that
stick; where it slides, p has its friction: a velocity along a normal that alternates from substep
to substep would else be seen, by friction, at every length. A motor that gives its most holds
nothing.
What bends of contact forces hide from both is added (`hidden_bends`).
"""

from __future__ import annotations

from math import sqrt
from typing import Any, Final

from .block import make_relative_velocity
from .collide.joint import direction, put_ends
from .collide.records import put_normal
from .compile import inner, kernel
from .contact import make_apply_block, make_complete_row, make_normal_velocity
from .effects import made_once
from .hidden_bends import BENDS, make_missed, make_note_loads
from .motor_reach import SPENDS
from .records import Field
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms
from .vectors import Vec3, length, minus, position

# A step of order 2 made in halves is off by a third of what it differs from the whole by.
SHARE = 1.0 / 3.0
# Velocities that two solves of one problem may differ by, in residuals; positions [m].
NOISE, PLACE_NOISE = 4.0, 1e-10
# Sweeps of the differences of velocities over contacts, at most; and where there are joints, whose
# rows are all but dependent, with each going beyond what it asks by so much (Young 1954).
SWEEPS, JOINT_SWEEPS, BEYOND = 20, 3000, 1.5
# What solves leave is along these rows, too, and may be far more than they part by: so much of
# it is left [-].
ENOUGH = 1e-3
# A contact sticks by less than this share of the most that its friction may be.
STICKS = 0.999
# What slides is pushed with its friction where that leaves this share of the response along the
# normal: beyond it jams (Painleve), and sweeps would not end.
RESPONDS = 0.5

# What a body has done since the run began.
PATH: Final[list[Field]] = [
    ("length", "f8"),  # of the path of its centre, and of its rim about it [m]
    ("fastest", "f8"),  # speed of its fastest point, at most [m/s]
    # Force of contacts on it, all together [N]: in the last half of the substep before, and in both
    # halves of this one.
    ("load", "f8"),
    ("first_load", "f8"),
    ("last_load", "f8"),
    ("load_dt", "f8"),  # of the half that `load` is of [s]
]


@inner
def distance(one, other):
    """Return how far two centres are apart [m]."""
    return length(minus(position(one), position(other)))


@inner
def angle(one, other):
    """Return the chord 2 sin(angle/2) between two orientations, to third order their angle."""
    x = one.qw * other.qx - one.qx * other.qw - one.qy * other.qz + one.qz * other.qy
    y = one.qw * other.qy - one.qy * other.qw - one.qz * other.qx + one.qx * other.qz
    z = one.qw * other.qz - one.qz * other.qw - one.qx * other.qy + one.qy * other.qx
    return 2.0 * sqrt(x * x + y * y + z * z)


def make_point_speed(spec: Spec) -> Any:
    """Return `kernel(body, v) -> |v| + R |w|`: no point of the body is faster [m/s]."""
    turns = step_terms(spec).turns

    def point_speed(body, v):
        speed = length(Vec3(v.vx, v.vy, v.vz))
        if turns:
            speed += body.bound * length(Vec3(v.wx, v.wy, v.wz))
        return speed

    return kernel(point_speed, spec)


def make_stand_at_end(spec: Spec) -> Any:
    """Return `kernel(state, count, velocities)`: rows of joints as their bodies stand.

    At the end of a step the ends of a joint part by p of O(dt^2), which the next one turns round.
    So a whole substep ends with -p, and its halves with p again: 2 p of their difference says
    nothing of what is to come. It is along rows at the end; of rows at the middle a share in
    proportion to dt is not, as is what a substep may be off by: none would be short enough.

    velocities: what rows of contacts with friction turn, by the inertia that these have.
    """
    bounded, levers = row_terms(spec).bounded, row_terms(spec).levers
    complete_row = make_complete_row(spec)
    _, place_parts = made_once(spec, "place_parts")
    carries_inertia, refresh_inertia = made_once(spec, "refresh_inertia")

    def stand_at_end(state, count, velocities):
        bodies = state.bodies
        place_parts(bodies)
        if carries_inertia:
            refresh_inertia(bodies, velocities)
        for c in range(count):
            contact = state.contacts[c]
            if contact.bilateral == 1:
                pair = state.pairs[contact.pair]
                end_a, end_b = bodies[pair.a], bodies[pair.b]
                a, b = bodies[contact.a], bodies[contact.b]
                turns = False
                if bounded:
                    turns = contact.couple == 1
                if not turns:
                    put_normal(contact, direction(pair.kind, end_a))
                if levers:
                    put_ends(contact, pair.kind, end_a, end_b, a, b)
                contact.k_n = complete_row(contact, a, b)

    return kernel(stand_at_end, spec)


def make_respect_contacts(spec: Spec) -> Any:
    """Return `kernel(contacts, count, velocities, noise)`: of differences of velocities.

    Takes from them what the contacts of the substep's end would, by Gauss-Seidel's method.
    """
    normal_velocity, apply_block = make_normal_velocity(spec), make_apply_block(spec)
    terms = row_terms(spec)
    friction, mixed = terms.frictional, terms.frictionless
    compliant, bilateral, bounded = terms.compliant, terms.bilateral, terms.bounded
    relative_velocity: Any = make_relative_velocity(spec)
    most = JOINT_SWEEPS if bilateral else SWEEPS
    beyond, enough = (BEYOND, ENOUGH) if bilateral else (1.0, 1.0)

    def acts(contact):
        pushes = contact.lambda_n > 0.0
        if compliant:
            pushes = pushes and contact.gamma == 0.0
        if bilateral:
            if contact.bilateral == 1:  # it holds, by an impulse of either sign
                pushes = True
                if bounded:
                    if contact.motor == 1:  # and one that gives its most does not
                        pushes = abs(contact.lambda_n) < SPENDS * contact.most
        return pushes

    acts = kernel(acts, spec)

    def sticks(contact):
        if mixed:
            if contact.frictional == 0:
                return False
        one, two, most = contact.lambda_1, contact.lambda_2, STICKS * contact.mu * contact.lambda_n
        return one * one + two * two < most * most

    def with_friction(contact):
        # The response along n to a push of 1 with the friction that it brings, and that friction.
        if mixed:
            if contact.frictional == 0:
                return contact.k_n, 0.0, 0.0
        if contact.lambda_n > 0.0 and not sticks(contact):
            one, two = contact.lambda_1 / contact.lambda_n, contact.lambda_2 / contact.lambda_n
            k = contact.k_n + contact.k_n1 * one + contact.k_n2 * two
            if k > RESPONDS * contact.k_n:
                return k, one, two
        return contact.k_n, 0.0, 0.0

    if friction:
        sticks = kernel(sticks, spec)
        with_friction = kernel(with_friction, spec)

    def respect_contacts(contacts, count, velocities, noise):
        for _ in range(most):
            largest = 0.0
            for c in range(count):
                contact = contacts[c]
                if acts(contact):
                    va, vb = velocities[contact.a], velocities[contact.b]
                    v_n = normal_velocity(contact, va, vb)
                    largest = max(largest, abs(v_n))
                    k, one, two = contact.k_n, 0.0, 0.0
                    if friction:
                        k, one, two = with_friction(contact)
                    push = -beyond * v_n / k
                    apply_block(contact, va, vb, push, push * one, push * two)
                    if friction:
                        if sticks(contact):
                            x, y, z = relative_velocity(contact, va, vb)
                            v_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                            v_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                            largest = max(largest, abs(v_1), abs(v_2))
                            one = contact.i_11 * v_1 + contact.i_12 * v_2
                            two = contact.i_12 * v_1 + contact.i_22 * v_2
                            apply_block(contact, va, vb, 0.0, -one, -two)
            if largest <= enough * noise:
                break

    return kernel(respect_contacts, spec)


def make_add_paths(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities, before, paths, half)`: those through a substep added.

    before: rows of the bodies at its start; half: of the substep [s].
    """
    turns, point_speed = step_terms(spec).turns, make_point_speed(spec)

    def add_paths(bodies, velocities, before, paths, half):
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.inv_m > 0.0:
                moved = distance(body, before[i])
                if turns:
                    moved += body.bound * angle(body, before[i])
                paths[i].length += moved
                paths[i].load, paths[i].load_dt = paths[i].last_load, half
                paths[i].fastest = max(paths[i].fastest, point_speed(body, velocities[i]))

    return kernel(add_paths, spec)


def make_estimate(spec: Spec) -> Any:
    """Return `kernel(state, count, left, params, residual, ordered)`.

    `state.control` has the bodies that the whole substep led to, and its velocities, which are made
    differences. left: of the run, behind the substep [s]; residual: of its last solve [m/s];
    ordered: whether all impacts of the substep had their order.
    Returns e, the error of the same body that solves may leave, and that body; -1: none has one.
    """
    turns, touches = step_terms(spec).turns, spec.touches
    point_speed = make_point_speed(spec)
    respect_contacts: Any = make_respect_contacts(spec) if touches else None
    joined = row_terms(spec).bilateral
    stand_at_end: Any = make_stand_at_end(spec) if joined else None
    note_loads: Any = make_note_loads(spec) if touches else None
    missed: Any = make_missed(spec) if touches else None

    def subtract(v, dv):
        dv.vx, dv.vy, dv.vz = v.vx - dv.vx, v.vy - dv.vy, v.vz - dv.vz
        if turns:
            dv.wx, dv.wy, dv.wz = v.wx - dv.wx, v.wy - dv.wy, v.wz - dv.wz

    subtract = kernel(subtract, spec)

    def estimate(state, count, left, params, residual, ordered):
        bodies, velocities = state.bodies, state.velocities
        control = state.control
        other, differences, paths = control.whole, control.differences, control.paths
        noise = NOISE * min(residual, params.tolerance)
        for i in range(bodies.shape[0]):
            subtract(velocities[i], differences[i])
        if joined:
            stand_at_end(state, count, differences)
        if touches:
            respect_contacts(state.contacts, count, differences, noise)
            note_loads(state.contacts, count, paths, params.dt)
            record = control.record[0]
            bends = record.cuts == 0 and ordered and record.length > BENDS * params.timestep
        largest, floor, worst = 0.0, 0.0, -1
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.inv_m > 0.0:
                off, dv = distance(body, other[i]), point_speed(body, differences[i])
                if turns:
                    off += body.bound * angle(body, other[i])
                if touches:
                    if bends and paths[i].load > 0.0:
                        before, half = control.velocities[i], 0.5 * record.length
                        hidden = missed(
                            body, before, control.middle[i], velocities[i], paths[i], half
                        )
                        dv = max(dv, hidden / SHARE)
                speed = point_speed(body, velocities[i])
                speed = max(speed, paths[i].fastest, body.bound / params.duration)
                path = max(body.bound, paths[i].length + speed * left)
                error = max(off / path, dv / speed)
                # A NaN is larger than anything, and than what comes after it.
                if not error <= largest and largest == largest:
                    largest, worst = error, i
                    floor = max(PLACE_NOISE / path, noise / speed)
        return SHARE * largest, SHARE * floor, worst

    return kernel(estimate, spec)
