"""Newton steps on the convex problem of a round, with an exact line search along each.

    g(v) = M (v - v^k) - J^T (lambda(v) - lambda^k)
is the gradient of a convex function of the velocities, because every projected impulse lambda(v)
(`response`) is a projection. Its Hessian M + J^T E' J is sparse over bodies and positive
definite however redundant the contacts are. Each step factorises it (`factor`) and is shortened,
or lengthened, to where the slope along it is nearly gone.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...rotation import inertia_times
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from ...step_terms import step_terms
from .envelope import DOF, OF_A, OF_B, T1, T2, WX, WY, WZ
from .factor import make_factorise, make_solve_factorised
from .matrix import make_assemble
from .response import make_fill_rows, make_projected_impulse, make_stiffness
from .rounds import (
    IDLE_STEPS,
    LENGTHS,
    SLOPE_LEFT,
    STEPS_OF_A_ROUND,
    is_at_minimum,
    is_idle,
    is_slow,
)
from .torques import (
    make_advance_spin,
    make_directional_spin,
    make_gather_torque,
    make_torque_slope,
)


def make_assemble_mass(spec: Spec):
    """Return `kernel(bodies, size, workspace)`: masses and world inertias by position."""
    turns = step_terms(spec).turns

    def assemble_mass(bodies, size, workspace):
        for p in range(size):
            body, own = bodies[workspace.visited[p]], workspace.mass[p]
            own.m = 1.0 / body.inv_m
            own.xx, own.yy, own.zz = 1.0, 1.0, 1.0
            own.xy, own.xz, own.yz = 0.0, 0.0, 0.0
            if turns:
                own.xx, own.xy, own.xz = inertia_times(body, 1.0, 0.0, 0.0)
                _, own.yy, own.yz = inertia_times(body, 0.0, 1.0, 0.0)
                _, _, own.zz = inertia_times(body, 0.0, 0.0, 1.0)

    return kernel(assemble_mass, spec)


def make_body_of(spec: Spec):
    """Return `kernel(contact, workspace, own)`: block row of the body whose rows begin at `own`.

    own: OF_A or OF_B; -1 where it cannot move.
    """

    def body_of(contact, workspace, own):
        if own == OF_A:
            return workspace.position[contact.a] if contact.inv_m_a > 0.0 else -1
        return workspace.position[contact.b] if contact.inv_m_b > 0.0 else -1

    return kernel(body_of, spec)


def make_directional_derivative(spec: Spec, torques: bool = True):
    """Return `kernel(contacts, count, workspace)`: what a step adds to contacts' velocities.

    torques: of what resists turning, too.
    """
    friction = row_terms(spec).frictional
    fill_rows, body_of = make_fill_rows(spec), make_body_of(spec)
    spins, directional_spin = torques and resists_turning(spec), make_directional_spin(spec)

    def directional_derivative(contacts, count, workspace):
        rows, step = workspace.rows, workspace.step
        for c in range(count):
            contact = contacts[c]
            fill_rows(contact, rows)
            n, one, two = 0.0, 0.0, 0.0
            for own in (OF_A, OF_B):
                p = body_of(contact, workspace, own)
                if p >= 0:
                    for i in range(DOF):
                        x = step[DOF * p + i]
                        n += rows[own, i] * x
                        if friction:
                            one += rows[own + T1, i] * x
                            two += rows[own + T2, i] * x
            contact.step_n = n
            if friction:
                contact.step_1, contact.step_2 = one, two
            if spins:
                a, b = body_of(contact, workspace, OF_A), body_of(contact, workspace, OF_B)
                directional_spin(contact, a, b, step)

    return kernel(directional_derivative, spec)


def make_multiply_mass(spec: Spec):
    """Return `kernel(workspace, x, p, i) -> row i of block p of M x`."""

    def multiply(workspace, x, p, i):
        own = workspace.mass[p]
        at = DOF * p
        if i < WX:
            return own.m * x[at + i]
        wx, wy, wz = x[at + WX], x[at + WY], x[at + WZ]
        if i == WX:
            return own.xx * wx + own.xy * wy + own.xz * wz
        if i == WY:
            return own.xy * wx + own.yy * wy + own.yz * wz
        return own.xz * wx + own.yz * wy + own.zz * wz

    return kernel(multiply, spec)


def make_gather(spec: Spec, projected_impulse: Any, torques: bool = True):
    """Return `kernel(contacts, count, size, workspace)`: what is out of balance, as `gradient`.

    projected_impulse: kernel of a contact's response; torques: they respond, too.
    """
    friction = row_terms(spec).frictional
    fill_rows, body_of, multiply = (
        make_fill_rows(spec),
        make_body_of(spec),
        make_multiply_mass(spec),
    )
    spins = torques and resists_turning(spec)
    gather_torque = make_gather_torque(spec)

    def gather(contacts, count, size, workspace):
        # gradient = M change - J^T (lambda - lambda^k)
        gradient, rows = workspace.gradient, workspace.rows
        for p in range(size):
            for i in range(DOF):
                gradient[DOF * p + i] = multiply(workspace, workspace.change, p, i)
        for c in range(count):
            contact = contacts[c]
            n, one, two = projected_impulse(contact, 0.0)
            n -= contact.start_n
            if friction:
                one, two = one - contact.start_1, two - contact.start_2
            if n != 0.0 or one != 0.0 or two != 0.0:
                fill_rows(contact, rows)
                for own in (OF_A, OF_B):
                    p = body_of(contact, workspace, own)
                    if p >= 0:
                        for i in range(DOF):
                            total = n * rows[own, i]
                            if friction:
                                total += one * rows[own + T1, i] + two * rows[own + T2, i]
                            gradient[DOF * p + i] -= total
            if spins:
                a, b = body_of(contact, workspace, OF_A), body_of(contact, workspace, OF_B)
                gather_torque(contact, a, b, gradient)

    return kernel(gather, spec)


def make_take_step(spec: Spec, torques: bool = True):
    """Return `kernel(contacts, count, size, workspace, length)`: so much of the step is taken."""
    friction = row_terms(spec).frictional
    spins, advance_spin = torques and resists_turning(spec), make_advance_spin(spec)

    def take_step(contacts, count, size, workspace, length):
        for r in range(DOF * size):
            workspace.change[r] += length * workspace.step[r]
        for c in range(count):
            contact = contacts[c]
            contact.velocity_n += length * contact.step_n
            if friction:
                contact.velocity_1 += length * contact.step_1
                contact.velocity_2 += length * contact.step_2
                contact.step_1, contact.step_2 = 0.0, 0.0
            contact.step_n = 0.0
            if spins:
                advance_spin(contact, length)

    return kernel(take_step, spec)


def make_begin(spec: Spec):
    """Return `kernel(contacts, count, size, workspace)`: a round begins without a change."""
    friction = row_terms(spec).frictional

    def begin(contacts, count, size, workspace):
        for r in range(DOF * size):
            workspace.change[r] = 0.0
        for c in range(count):
            contact = contacts[c]
            contact.step_n = 0.0
            if friction:
                contact.step_1, contact.step_2 = 0.0, 0.0

    return kernel(begin, spec)


def make_minimise(spec: Spec):
    """Return `kernel(contacts, count, size, workspace, enough) -> (steps, found)`.

    Contacts have their `start` impulses, and their `velocity` is brought to the minimum's; enough:
    a further step need not gain more [J].
    """
    begin = make_begin(spec)
    descend = make_descend(spec, make_projected_impulse(spec), make_stiffness(spec))

    def minimise(contacts, count, size, workspace, enough):
        begin(contacts, count, size, workspace)
        return descend(contacts, count, size, workspace, enough, 0.0)

    return kernel(minimise, spec)


def make_descend(spec: Spec, projected_impulse: Any, stiffness: Any, torques: bool = True):
    """Return `kernel(contacts, count, size, workspace, enough, first) -> (steps, found)`.

    The same from a change of the velocities on, which the contacts' `velocity` has. first: slope of
    the first step [J]; 0: it is to come.
    projected_impulse, stiffness: kernels of a contact's response, see `response`. torques: they
    respond, too.
    """
    friction = row_terms(spec).frictional
    assemble = make_assemble(spec, stiffness, torques)
    gather, take_step = make_gather(spec, projected_impulse, torques), make_take_step(spec, torques)
    directional_derivative = make_directional_derivative(spec, torques)
    spins, torque_slope = torques and resists_turning(spec), make_torque_slope(spec)
    multiply = make_multiply_mass(spec)
    at_minimum, slow = kernel(is_at_minimum, spec), kernel(is_slow, spec)
    gains_nothing = kernel(is_idle, spec)
    factorise, solve_factorised = make_factorise(spec), make_solve_factorised(spec)

    def slope_at(contacts, count, length):
        # The contacts' part of the derivative along the step; it grows with the length.
        total = 0.0
        for c in range(count):
            contact = contacts[c]
            n, one, two = projected_impulse(contact, length)
            total -= contact.step_n * (n - contact.start_n)
            if friction:
                total -= contact.step_1 * (one - contact.start_1)
                total -= contact.step_2 * (two - contact.start_2)
            if spins:
                total += torque_slope(contact, length)
        return total

    slope_at = kernel(slope_at, spec)

    def choose_length(contacts, count, size, workspace, slope):
        constant, linear = 0.0, 0.0
        for p in range(size):
            for i in range(DOF):
                s = workspace.step[DOF * p + i]
                constant += s * multiply(workspace, workspace.change, p, i)
                linear += s * multiply(workspace, workspace.step, p, i)
        length, low, high = 1.0, 0.0, -1.0
        left = slope
        for _ in range(LENGTHS):
            left = constant + length * linear + slope_at(contacts, count, length)
            if abs(left) <= SLOPE_LEFT * abs(slope):
                break
            if left > 0.0:
                high = length
            else:
                low = length
            length = 0.5 * (low + high) if high > 0.0 else 2.0 * length
        return length

    choose_length = kernel(choose_length, spec)

    def descend(contacts, count, size, workspace, enough, first):
        rows = DOF * size
        before, idle = 0.0, 0
        for done in range(STEPS_OF_A_ROUND):
            gather(contacts, count, size, workspace)
            assemble(contacts, count, size, workspace)
            if not factorise(size, workspace):
                return done, False
            for r in range(rows):
                workspace.step[r] = -workspace.gradient[r]
            solve_factorised(size, workspace, workspace.step)
            slope = 0.0
            for r in range(rows):
                slope += workspace.step[r] * workspace.gradient[r]
            if first == 0.0:
                first = slope
            if at_minimum(slope, first, enough):
                return done + 1, slope == slope
            if gains_nothing(slope, before, first):
                idle += 1
                if idle == IDLE_STEPS:
                    return done + 1, True
            before = slope
            if slow(done, slope, first):
                return done + 1, False
            directional_derivative(contacts, count, workspace)
            length = choose_length(contacts, count, size, workspace, slope)
            take_step(contacts, count, size, workspace, length)
        return STEPS_OF_A_ROUND, False

    return kernel(descend, spec)
