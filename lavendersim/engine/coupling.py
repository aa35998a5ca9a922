"""How impulses reach velocities: through bodies, or by the blocks of W; solvers serve both.

    bodies   an impulse changes the velocities of two bodies, and contacts look at bodies:
             u = J v, v = M^-1 J^T r, one visit for a contact however many share its bodies
    matrix   an impulse changes the velocities of every contact it is coupled to, by the blocks of
             its column of W (`contact_problem`), for problems of which nothing else is known
In the second, `velocities` is a `Coupling` and each contact carries its own velocity.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .block import make_slip_velocity
from .compile import kernel
from .contact import make_apply_all, make_apply_block, make_frictionless_velocity
from .records import F8, I8, Field
from .row_terms import by_friction
from .spec import Spec

# A contact of a problem given by its matrix; the names that bodies' contacts have too mean the
# same. w includes free velocity and target.
MATRIX_CONTACT: list[Field] = [
    *[(name, F8) for name in ("lambda_n", "lambda_1", "lambda_2")],  # [N s]
    *[(name, F8) for name in ("w_n", "w_1", "w_2")],  # velocity [m/s]
    ("mu", F8),
    ("gamma", F8),
    ("target", F8),  # 0: part of w_n
    ("k_n", F8),
    ("inv_k", F8),
    ("k_n1", F8),
    ("k_n2", F8),
    ("k_t", F8),
    ("i_11", F8),
    ("i_12", F8),
    ("i_22", F8),
    ("bound", F8),  # W is no stiffer than the diagonal matrix of these [1/kg]
    ("begin", I8),  # blocks of its column
    ("end", I8),
]


class Coupling(NamedTuple):
    """W by columns, and what `scaled_residual` scales by."""

    row: np.ndarray  # (m,) contact that a block acts on
    blocks: np.ndarray  # (m, 3, 3) [1/kg]
    mean_diagonal: float  # tr W / 3n [1/kg]
    load: float  # |q|, or 1 without a load [m/s]


def make_contact_velocity(spec: Spec) -> Any:
    """Return `kernel(contact, velocities) -> (w_n, w_1, w_2)` [m/s].

    The contact's velocity with its target and what its surfaces bring, but without compliance.
    """
    if spec.operator == "matrix":
        return make_frictional_velocity(spec)
    return by_friction(spec, _make_frictionless_contact_velocity, make_frictional_velocity)


def _make_frictionless_contact_velocity(spec: Spec) -> Any:
    normal_velocity = make_frictionless_velocity(spec)

    def frictionless_contact_velocity(contact, velocities):
        va, vb = velocities[contact.a], velocities[contact.b]
        return normal_velocity(contact, va, vb) + contact.target, 0.0, 0.0

    return kernel(frictionless_contact_velocity, spec)


def make_frictional_velocity(spec: Spec) -> Any:
    """Return the same kernel for frictional contacts."""
    if spec.operator == "matrix":

        def matrix_velocity(contact, velocities):
            return contact.w_n, contact.w_1, contact.w_2

        return kernel(matrix_velocity, spec)
    slip_velocity = make_slip_velocity(spec)

    def contact_velocity(contact, velocities):
        v_n, v_1, v_2 = slip_velocity(contact, velocities[contact.a], velocities[contact.b])
        return v_n + contact.target, v_1, v_2

    return kernel(contact_velocity, spec)


def make_add_impulse(spec: Spec) -> Any:
    """Return `kernel(contact, contacts, velocities, n, one, two)`: + on B, - on A [N s].

    Velocities follow; what the contact has accumulated is the caller's.
    """
    return _make_add(spec, make_apply_block)


def make_add_frictional(spec: Spec) -> Any:
    """Return the same kernel for frictional contacts."""
    return _make_add(spec, make_apply_all)


def _make_add(spec: Spec, make_apply: Any) -> Any:
    if spec.operator == "matrix":

        def add_by_matrix(contact, contacts, velocities, n, one, two):
            row, blocks = velocities.row, velocities.blocks
            for k in range(contact.begin, contact.end):
                other = contacts[row[k]]
                other.w_n += blocks[k, 0, 0] * n + blocks[k, 0, 1] * one + blocks[k, 0, 2] * two
                other.w_1 += blocks[k, 1, 0] * n + blocks[k, 1, 1] * one + blocks[k, 1, 2] * two
                other.w_2 += blocks[k, 2, 0] * n + blocks[k, 2, 1] * one + blocks[k, 2, 2] * two

        return kernel(add_by_matrix, spec)
    apply = make_apply(spec)

    def add_impulse(contact, contacts, velocities, n, one, two):
        apply(contact, velocities[contact.a], velocities[contact.b], n, one, two)

    return kernel(add_impulse, spec)
