"""Newton steps on the convex problem of a round, with an exact line search along each.

    g(v) = M (v - v^k) - J^T (lambda(v) - lambda^k)
is the gradient of a convex function of the velocities, because every projected impulse lambda(v)
(`response`) is a projection. Its Hessian M + J^T E' J is sparse over bodies and positive
definite however redundant the contacts are. Each step factorises it (`envelope`) and is shortened,
or lengthened, to where the slope along it is nearly gone.
"""

from __future__ import annotations

from ...compile import kernel
from ...rotation import inertia_times
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import DOF, factorise, solve_factorised
from .matrix import make_assemble
from .response import make_fill_rows, make_projected_impulse
from .torques import (
    make_advance_spin,
    make_directional_spin,
    make_gather_torque,
    make_torque_slope,
)

# Steps at most. The one that finds every contact in its final state is the last but one.
MOST_STEPS = 24
# By this step the gain of the next one has fallen to this share, or the round is given up [-].
LOOK_BACK, LOOKED_FOR = 8, 0.1
# Nothing is left to gain below this share of what the first step gains: round-off [-].
ROUND_OFF = 1e-20
# A length is good when it leaves this share of the slope along the step [-]; trials of it.
SLOPE_LEFT = 0.2
LENGTHS = 40


def make_assemble_mass(spec: Spec):
    """Return `kernel(bodies, size, workspace)`: masses and world inertias by position."""
    turns = spec.has("rotation")

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


def make_minimise(spec: Spec):
    """Return `kernel(contacts, count, size, workspace, enough) -> (steps, found)`.

    Contacts have their `start` impulses, and their `velocity` is brought to the minimum's; enough:
    a further step need not gain more [J].
    """
    friction = spec.has("friction")
    directions = 3 if friction else 1
    projected_impulse, fill_rows = make_projected_impulse(spec), make_fill_rows(spec)
    assemble = make_assemble(spec)
    spins = resists_turning(spec)
    gather_torque, directional_spin = make_gather_torque(spec), make_directional_spin(spec)
    torque_slope, advance_spin = make_torque_slope(spec), make_advance_spin(spec)

    def multiply(workspace, x, p, i):
        # Row i of block p of M x.
        own = workspace.mass[p]
        at = DOF * p
        if i < 3:
            return own.m * x[at + i]
        wx, wy, wz = x[at + 3], x[at + 4], x[at + 5]
        if i == 3:
            return own.xx * wx + own.xy * wy + own.xz * wz
        if i == 4:
            return own.xy * wx + own.yy * wy + own.yz * wz
        return own.xz * wx + own.yz * wy + own.zz * wz

    multiply = kernel(multiply, spec)

    def body_of(contact, workspace, side):
        if side == 0:
            return workspace.position[contact.a] if contact.inv_m_a > 0.0 else -1
        return workspace.position[contact.b] if contact.inv_m_b > 0.0 else -1

    body_of = kernel(body_of, spec)

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
                for side in range(2):
                    p = body_of(contact, workspace, side)
                    if p >= 0:
                        for i in range(DOF):
                            total = n * rows[3 * side, i]
                            if friction:
                                total += one * rows[3 * side + 1, i] + two * rows[3 * side + 2, i]
                            gradient[DOF * p + i] -= total
            if spins:
                a, b = body_of(contact, workspace, 0), body_of(contact, workspace, 1)
                gather_torque(contact, a, b, gradient)

    gather = kernel(gather, spec)

    def directional_derivative(contacts, count, workspace):
        # What the step adds to the velocities that contacts see.
        rows, step = workspace.rows, workspace.step
        for c in range(count):
            contact = contacts[c]
            fill_rows(contact, rows)
            n, one, two = 0.0, 0.0, 0.0
            for side in range(2):
                p = body_of(contact, workspace, side)
                if p >= 0:
                    for i in range(DOF):
                        x = step[DOF * p + i]
                        n += rows[3 * side, i] * x
                        if directions == 3:
                            one += rows[3 * side + 1, i] * x
                            two += rows[3 * side + 2, i] * x
            contact.step_n = n
            if friction:
                contact.step_1, contact.step_2 = one, two
            if spins:
                a, b = body_of(contact, workspace, 0), body_of(contact, workspace, 1)
                directional_spin(contact, a, b, step)

    directional_derivative = kernel(directional_derivative, spec)

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

    def minimise(contacts, count, size, workspace, enough):
        rows = DOF * size
        first = 0.0
        for r in range(rows):
            workspace.change[r] = 0.0
        for c in range(count):
            contact = contacts[c]
            contact.step_n = 0.0
            if friction:
                contact.step_1, contact.step_2 = 0.0, 0.0
        for done in range(MOST_STEPS):
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
            if done == 0:
                first = slope
            if not slope < min(ROUND_OFF * first, -enough):
                return done + 1, slope == slope
            if done == LOOK_BACK:
                if slope < LOOKED_FOR * first:
                    return done + 1, False
            directional_derivative(contacts, count, workspace)
            length = choose_length(contacts, count, size, workspace, slope)
            for r in range(rows):
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
        return MOST_STEPS, False

    return kernel(minimise, spec)
