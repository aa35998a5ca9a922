"""The matrix of Newton's method, M + J^T E' J, assembled over the bodies.

It lies in the envelope (`envelope`): block rows of bodies, each from its first neighbour on.
"""

from __future__ import annotations

from ...compile import kernel
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import DOF
from .response import make_fill_rows, make_stiffness
from .torques import make_add_torque_block


def make_assemble(spec: Spec):
    """Return `kernel(contacts, count, size, workspace)`: fill the envelope with M + J^T E' J."""
    friction = spec.has("friction")
    fill_rows, stiffness = make_fill_rows(spec), make_stiffness(spec)
    directions = 3 if friction else 1
    spins, add_torque_block = resists_turning(spec), make_add_torque_block(spec)

    def add_block(workspace, p, q, rows_p, rows_q):
        # += rows_p^T E' rows_q on block row p and block column q <= p; E' rows_q are rows 6..8.
        values, start, rows = workspace.values, workspace.start, workspace.rows
        offset = DOF * (q - workspace.first[p])
        for i in range(DOF):
            base = start[DOF * p + i] + offset
            for j in range(i + 1 if p == q else DOF):
                total = 0.0
                for k in range(directions):
                    total += rows[rows_p + k, i] * rows[6 + k, j]
                values[base + j] += total

    add_block = kernel(add_block, spec)

    def scale_rows(rows, source, h):
        for j in range(DOF):
            n = rows[source, j]
            rows[6, j] = h.nn * n
            if friction:
                one, two = rows[source + 1, j], rows[source + 2, j]
                rows[6, j] += h.n1 * one + h.n2 * two
                rows[7, j] = h.n1 * n + h.t11 * one + h.t12 * two
                rows[8, j] = h.n2 * n + h.t12 * one + h.t22 * two

    scale_rows = kernel(scale_rows, spec)

    def assemble(contacts, count, size, workspace):
        values, start, mass = workspace.values, workspace.start, workspace.mass
        last = DOF * size - 1
        for k in range(start[last] + last - DOF * workspace.first[size - 1] + 1):
            values[k] = 0.0
        for p in range(size):
            offset = DOF * (p - workspace.first[p])
            own = mass[p]
            for i in range(3):
                values[start[DOF * p + i] + offset + i] = own.m
            values[start[DOF * p + 3] + offset + 3] = own.xx
            base = start[DOF * p + 4] + offset
            values[base + 3], values[base + 4] = own.xy, own.yy
            base = start[DOF * p + 5] + offset
            values[base + 3], values[base + 4], values[base + 5] = own.xz, own.yz, own.zz
        for c in range(count):
            contact = contacts[c]
            h = stiffness(contact)
            a = workspace.position[contact.a] if contact.inv_m_a > 0.0 else -1
            b = workspace.position[contact.b] if contact.inv_m_b > 0.0 else -1
            if h.nn > 0.0:
                fill_rows(contact, workspace.rows)
                if a >= 0:
                    scale_rows(workspace.rows, 0, h)
                    add_block(workspace, a, a, 0, 0)
                    if b > a:
                        add_block(workspace, b, a, 3, 0)
                if b >= 0:
                    scale_rows(workspace.rows, 3, h)
                    add_block(workspace, b, b, 3, 3)
                    if a > b:
                        add_block(workspace, a, b, 0, 3)
            if spins:
                add_torque_block(contact, a, b, workspace)

    return kernel(assemble, spec)
