"""The matrix of Newton's method, M + J^T E' J, assembled over the bodies.

It lies in the envelope (`envelope`), block rows of bodies, each from its first neighbour on, or in
the panels of supernodes (`factor`).
"""

from __future__ import annotations

from typing import Any

from ...compile import kernel
from ...row_terms import row_terms
from ...spec import Spec
from ...spin_block import resists_turning
from .envelope import DOF, OF_A, OF_B, SCALED, T1, T2, WX, WY, WZ
from .factor import entry, make_block_at, make_entries, make_factorise_lu
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
    """Return `kernel(contacts, count, size, workspace)`: fill the matrix with M + J^T E' J.

    stiffness: kernel(contact) -> E'. torques: they respond, too. scale: kernel(rows, source, h)
    that scales rows by E'; None: by a symmetric one.
    """
    friction, fill_rows = row_terms(spec).frictional, make_fill_rows(spec)
    directions = 3 if friction else 1
    scale_rows = make_scale_rows(spec) if scale is None else scale
    spins, add_torque_block = torques and resists_turning(spec), make_add_torque_block(spec)
    block_at, entries_of = make_block_at(spec), make_entries(spec)

    def add_block(workspace, p, q, rows_p, rows_q):
        # += rows_p^T E' rows_q on block row p and block column q <= p; E' rows_q: the scaled rows.
        values, rows = workspace.values, workspace.rows
        block = block_at(workspace, p, q)
        for i in range(DOF):
            row = entry(block, i, 0)
            for j in range(i + 1 if p == q else DOF):
                total = 0.0
                for k in range(directions):
                    total += rows[rows_p + k, i] * rows[SCALED + k, j]
                values[row + j * block.column] += total

    add_block = kernel(add_block, spec)

    def assemble(contacts, count, size, workspace):
        values = workspace.values
        for k in range(entries_of(size, workspace)):
            values[k] = 0.0
        for p in range(size):
            block, own = block_at(workspace, p, p), workspace.mass[p]
            for i in range(3):
                values[entry(block, i, i)] = own.m
            values[entry(block, WX, WX)] = own.xx
            values[entry(block, WY, WX)], values[entry(block, WY, WY)] = own.xy, own.yy
            values[entry(block, WZ, WX)], values[entry(block, WZ, WY)] = own.xz, own.yz
            values[entry(block, WZ, WZ)] = own.zz
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


def make_assemble_and_factorise(
    spec: Spec, stiffness: Any, scales: tuple[Any, Any], torques: bool = True
) -> Any:
    """Return `kernel(contacts, count, size, workspace) -> whether` there is a factor.

    Of M + J^T E' J, see `matrix.make_assemble`; scales: by E', and by E' transposed.
    """
    scale, transposed = scales
    assemble = make_assemble(spec, stiffness, torques, scale)
    assemble_transposed = make_assemble(spec, stiffness, torques, transposed)
    entries_of, factorise_lu = make_entries(spec), make_factorise_lu(spec)

    def assemble_and_factorise(contacts, count, size, workspace):
        assemble_transposed(contacts, count, size, workspace)
        for k in range(entries_of(size, workspace)):
            workspace.upper[k] = workspace.values[k]
        assemble(contacts, count, size, workspace)
        return factorise_lu(size, workspace)

    return kernel(assemble_and_factorise, spec)
