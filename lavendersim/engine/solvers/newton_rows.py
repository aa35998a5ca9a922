"""What Newton's method asks of contacts: their answer to velocities, and their share of the matrix.

A contact answers the velocities w it sees, around the impulses lambda^k it holds, with the nearest
impulse in Coulomb's cone, nearest in the metric 1/e:
    lambda = proj(x),   x = s lambda^k - e w,   |lambda_t| <= mu lambda_n,
s = 1/(1 + E gamma) and e = E s along the normal, where compliance gamma is; 1 and E elsewhere.
"""

from __future__ import annotations

from math import sqrt

from ..block import make_relative_velocity
from ..compile import kernel
from ..contact import make_normal_velocity
from ..spec import Spec
from .envelope import DOF

FIELDS = [
    *[
        (f"{name}_{axis}", "f8")
        # lambda^k [N s], the velocities seen, and those that a step adds [m/s].
        for name in ("held", "seen", "step")
        for axis in "n12"
    ],
    ("scale", "f8"),  # s
    ("stiff_n", "f8"),  # e along the normal and in the tangent plane [kg]
    ("stiff_t", "f8"),
]


def make_start(spec: Spec):
    """Return `kernel(contacts, count, velocities, softness, at_rest)`: rows at their impulses.

    1/softness is the stiffness of an answer, relative to the row's own effective mass [-]; at_rest:
    what slides is taken to stop.
    """
    friction, compliant = spec.has("friction"), spec.has("compliance")
    moving_surface = spec.has("surface_velocity")
    normal_velocity = make_normal_velocity(spec)
    relative_velocity = make_relative_velocity(spec)

    def start(contacts, count, velocities, softness, at_rest):
        for c in range(count):
            contact = contacts[c]
            va, vb = velocities[contact.a], velocities[contact.b]
            stiff = 1.0 / (softness * contact.k_n)
            contact.scale = 1.0
            if compliant:
                contact.scale = 1.0 / (1.0 + stiff * contact.gamma)
            contact.stiff_n = stiff * contact.scale
            contact.held_n = contact.lambda_n
            if friction:
                x, y, z = relative_velocity(contact, va, vb)
                contact.seen_n = contact.nx * x + contact.ny * y + contact.nz * z + contact.target
                contact.seen_1 = contact.t1x * x + contact.t1y * y + contact.t1z * z
                contact.seen_2 = contact.t2x * x + contact.t2y * y + contact.t2z * z
                if moving_surface:
                    contact.seen_1 += contact.surface_1
                    contact.seen_2 += contact.surface_2
                if not at_rest:  # De Saxce's shift
                    squared = contact.seen_1 * contact.seen_1 + contact.seen_2 * contact.seen_2
                    contact.seen_n += contact.mu * sqrt(squared)
                contact.stiff_t = 1.0 / (softness * contact.k_t)
                contact.held_1, contact.held_2 = contact.lambda_1, contact.lambda_2
            else:
                contact.seen_n = normal_velocity(contact, va, vb) + contact.target

    return kernel(start, spec)


def make_answer(spec: Spec):
    """Return `kernel(contact, length) -> (lambda_n, lambda_1, lambda_2)` so far along the step."""
    friction = spec.has("friction")

    def answer(contact, length):
        n = contact.scale * contact.held_n
        n -= contact.stiff_n * (contact.seen_n + length * contact.step_n)
        if not friction:
            return max(n, 0.0), 0.0, 0.0
        one = contact.held_1 - contact.stiff_t * (contact.seen_1 + length * contact.step_1)
        two = contact.held_2 - contact.stiff_t * (contact.seen_2 + length * contact.step_2)
        mu = contact.mu
        r = sqrt(one * one + two * two)
        if r <= mu * n:
            return n, one, two
        weight = mu * contact.stiff_n / contact.stiff_t
        n = (n + weight * r) / (1.0 + weight * mu)
        if n <= 0.0:
            return 0.0, 0.0, 0.0
        scale = mu * n / r
        return n, one * scale, two * scale

    return kernel(answer, spec)


def make_stiffness(spec: Spec):
    """Return `kernel(contact) -> (h_nn, h_n1, h_n2, h_11, h_12, h_22)`: -d answer / d w."""
    friction = spec.has("friction")

    def stiffness(contact):
        n = contact.scale * contact.held_n - contact.stiff_n * contact.seen_n
        e_n = contact.stiff_n
        if not friction:
            return (e_n if n > 0.0 else 0.0), 0.0, 0.0, 0.0, 0.0, 0.0
        e_t, mu = contact.stiff_t, contact.mu
        one = contact.held_1 - e_t * contact.seen_1
        two = contact.held_2 - e_t * contact.seen_2
        r = sqrt(one * one + two * two)
        if r <= mu * n:
            return e_n, 0.0, 0.0, e_t, 0.0, e_t
        weight = mu * e_n / e_t
        n = (n + weight * r) / (1.0 + weight * mu)
        if n <= 0.0:
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        # Along the ray of the cone's surface, and around it.
        u, v = one / r, two / r
        ray = e_n / (1.0 + weight * mu)
        around = e_t * mu * n / r
        along = mu * mu * ray - around
        return (
            ray,
            mu * ray * u,
            mu * ray * v,
            around + along * u * u,
            along * u * v,
            around + along * v * v,
        )

    return kernel(stiffness, spec)


def make_fill_rows(spec: Spec):
    """Return `kernel(contact, rows)`: rows 0..2 of A (n, t1, t2) and 3..5 of B, as J has them."""
    friction, torque = spec.has("friction"), spec.has("contact_torque")

    def fill(rows, k, x, y, z, contact):
        rows[k, 0], rows[k, 1], rows[k, 2] = -x, -y, -z
        rows[k, 3] = contact.raz * y - contact.ray * z
        rows[k, 4] = contact.rax * z - contact.raz * x
        rows[k, 5] = contact.ray * x - contact.rax * y
        rows[k + 3, 0], rows[k + 3, 1], rows[k + 3, 2] = x, y, z
        rows[k + 3, 3] = contact.rby * z - contact.rbz * y
        rows[k + 3, 4] = contact.rbz * x - contact.rbx * z
        rows[k + 3, 5] = contact.rbx * y - contact.rby * x

    fill = kernel(fill, spec)

    def fill_block(contact, rows):
        fill(rows, 0, contact.nx, contact.ny, contact.nz, contact)
        fill(rows, 1, contact.t1x, contact.t1y, contact.t1z, contact)
        fill(rows, 2, contact.t2x, contact.t2y, contact.t2z, contact)

    def fill_normal(contact, rows):
        rows[0, 0], rows[0, 1], rows[0, 2] = -contact.nx, -contact.ny, -contact.nz
        rows[3, 0], rows[3, 1], rows[3, 2] = contact.nx, contact.ny, contact.nz
        if torque:
            rows[0, 3], rows[0, 4] = -contact.lever_ax, -contact.lever_ay
            rows[0, 5] = -contact.lever_az
            rows[3, 3], rows[3, 4] = contact.lever_bx, contact.lever_by
            rows[3, 5] = contact.lever_bz

    return kernel(fill_block if friction else fill_normal, spec)


def make_assemble(spec: Spec):
    """Return `kernel(contacts, count, size, space)`: fill the envelope with M + J^T E' J."""
    friction = spec.has("friction")
    fill_rows, stiffness = make_fill_rows(spec), make_stiffness(spec)
    directions = 3 if friction else 1

    def add_block(space, p, q, rows_p, rows_q):
        # += rows_p^T E' rows_q on block row p and block column q <= p; E' rows_q are rows 6..8.
        values, start, rows = space.values, space.start, space.rows
        offset = DOF * (q - space.first[p])
        for i in range(DOF):
            base = start[DOF * p + i] + offset
            for j in range(i + 1 if p == q else DOF):
                total = 0.0
                for k in range(directions):
                    total += rows[rows_p + k, i] * rows[6 + k, j]
                values[base + j] += total

    add_block = kernel(add_block, spec)

    def scale_rows(space, source, h_nn, h_n1, h_n2, h_11, h_12, h_22):
        rows = space.rows
        for j in range(DOF):
            n = rows[source, j]
            rows[6, j] = h_nn * n
            if friction:
                one, two = rows[source + 1, j], rows[source + 2, j]
                rows[6, j] += h_n1 * one + h_n2 * two
                rows[7, j] = h_n1 * n + h_11 * one + h_12 * two
                rows[8, j] = h_n2 * n + h_12 * one + h_22 * two

    scale_rows = kernel(scale_rows, spec)

    def assemble(contacts, count, size, space):
        values, start, mass = space.values, space.start, space.mass
        last = DOF * size - 1
        for k in range(start[last] + last - DOF * space.first[size - 1] + 1):
            values[k] = 0.0
        for p in range(size):
            offset = DOF * (p - space.first[p])
            for i in range(3):
                values[start[DOF * p + i] + offset + i] = mass[p, 0]
            values[start[DOF * p + 3] + offset + 3] = mass[p, 1]
            base = start[DOF * p + 4] + offset
            values[base + 3], values[base + 4] = mass[p, 2], mass[p, 4]
            base = start[DOF * p + 5] + offset
            values[base + 3], values[base + 4], values[base + 5] = (
                mass[p, 3],
                mass[p, 5],
                mass[p, 6],
            )
        for c in range(count):
            contact = contacts[c]
            h_nn, h_n1, h_n2, h_11, h_12, h_22 = stiffness(contact)
            if h_nn > 0.0:
                fill_rows(contact, space.rows)
                a = space.position[contact.a] if contact.inv_m_a > 0.0 else -1
                b = space.position[contact.b] if contact.inv_m_b > 0.0 else -1
                if a >= 0:
                    scale_rows(space, 0, h_nn, h_n1, h_n2, h_11, h_12, h_22)
                    add_block(space, a, a, 0, 0)
                    if b > a:
                        add_block(space, b, a, 3, 0)
                if b >= 0:
                    scale_rows(space, 3, h_nn, h_n1, h_n2, h_11, h_12, h_22)
                    add_block(space, b, b, 3, 3)
                    if a > b:
                        add_block(space, a, b, 0, 3)

    return kernel(assemble, spec)
