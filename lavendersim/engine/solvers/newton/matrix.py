"""The matrix of Newton's method, M + J^T E' J, assembled over the bodies.

It lies in the envelope (`envelope`): block rows of bodies, each from its first neighbour on.
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import DOF, OF_A, OF_B, SCALED, T1, T2, WX, WY, WZ
from .response import make_fill_rows
from .torques import make_add_torque_block


def make_scale_rows(spec: Spec) -> Any:
    """Return `kernel(rows, source, h)`: the scaled rows are h times those from `source` on."""
    friction = row_terms(spec).frictional

    def scale_rows(rows, source, h):
        for j in range(DOF):
            n = rows[source, j]
            rows[SCALED, j] = h.nn * n
            if friction:
                one, two = rows[source + T1, j], rows[source + T2, j]
                rows[SCALED, j] += h.n1 * one + h.n2 * two
                rows[SCALED + T1, j] = h.n1 * n + h.t11 * one + h.t12 * two
                rows[SCALED + T2, j] = h.n2 * n + h.t12 * one + h.t22 * two

    return kernel(scale_rows, spec)


def make_assemble(spec: Spec, stiffness: Any, torques: bool = True, scale: Any = None):
    """Return `kernel(contacts, count, size, workspace)`: fill the envelope with M + J^T E' J.

    stiffness: kernel(contact) -> E'. torques: they respond, too. scale: kernel(rows, source, h)
    that scales rows by E'; None: by a symmetric one.
    """
    friction, fill_rows = row_terms(spec).frictional, make_fill_rows(spec)
    directions = 3 if friction else 1
    scale_rows = make_scale_rows(spec) if scale is None else scale
    spins, add_torque_block = torques and resists_turning(spec), make_add_torque_block(spec)

    def add_block(workspace, p, q, rows_p, rows_q):
        # += rows_p^T E' rows_q on block row p and block column q <= p; E' rows_q: the scaled rows.
        values, start, rows = workspace.values, workspace.start, workspace.rows
        offset = DOF * (q - workspace.first[p])
        for i in range(DOF):
            base = start[DOF * p + i] + offset
            for j in range(i + 1 if p == q else DOF):
                total = 0.0
                for k in range(directions):
                    total += rows[rows_p + k, i] * rows[SCALED + k, j]
                values[base + j] += total

    add_block = kernel(add_block, spec)

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
            values[start[DOF * p + WX] + offset + WX] = own.xx
            base = start[DOF * p + WY] + offset
            values[base + WX], values[base + WY] = own.xy, own.yy
            base = start[DOF * p + WZ] + offset
            values[base + WX], values[base + WY], values[base + WZ] = own.xz, own.yz, own.zz
        for c in range(count):
            contact = contacts[c]
            h = stiffness(contact)
            a = workspace.position[contact.a] if contact.inv_m_a > 0.0 else -1
            b = workspace.position[contact.b] if contact.inv_m_b > 0.0 else -1
            if h.nn > 0.0:
                fill_rows(contact, workspace.rows)
                if a >= 0:
                    scale_rows(workspace.rows, OF_A, h)
                    add_block(workspace, a, a, OF_A, OF_A)
                    if b > a:
                        add_block(workspace, b, a, OF_B, OF_A)
                if b >= 0:
                    scale_rows(workspace.rows, OF_B, h)
                    add_block(workspace, b, b, OF_B, OF_B)
                    if a > b:
                        add_block(workspace, a, b, OF_A, OF_B)
            if spins:
                add_torque_block(contact, a, b, workspace)

    return kernel(assemble, spec)
