"""The impulse of a contact by Coulomb's law itself, as a function of velocities; its derivative.

At contact velocity w, around the impulse lambda^k that a round begins with (`alart_curnier`):
    lambda_n = max(0, s lambda_n^k - e w_n),    lambda_t = proj(lambda_t^k - E w_t),
onto the disc |lambda_t| <= mu lambda_n; s, e and E as in `response`. What resists no slip responds
as it does there.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from ...compile import kernel
from ...row_terms import by_friction
from ...spec import Spec
from .envelope import DOF, SCALED, T1, T2
from .response import Stiffness, make_frictionless_stiffness, make_projected_normal


def make_coulomb_impulse(spec: Spec) -> Any:
    """Return `kernel(contact, length) -> (lambda_n, lambda_1, lambda_2)` so far along the step."""
    return by_friction(spec, make_projected_normal, _make_coulomb_block)


def _make_coulomb_block(spec: Spec) -> Any:
    def coulomb_impulse(contact, length):
        n = contact.scale * contact.start_n
        n -= contact.stiff_n * (contact.velocity_n + length * contact.step_n)
        if n <= 0.0:
            return 0.0, 0.0, 0.0
        one = contact.start_1 - contact.stiff_t * (contact.velocity_1 + length * contact.step_1)
        two = contact.start_2 - contact.stiff_t * (contact.velocity_2 + length * contact.step_2)
        r, limit = sqrt(one * one + two * two), contact.mu * n
        if r > limit:
            one, two = one * (limit / r), two * (limit / r)
        return n, one, two

    return kernel(coulomb_impulse, spec)


def make_coulomb_stiffness(spec: Spec) -> Any:
    """Return `kernel(contact) -> Stiffness`: E' = -d lambda / d w.

    n1 and n2 are those of lambda_1 and lambda_2 by w_n: lambda_n does not follow w_t.
    """
    return by_friction(spec, make_frictionless_stiffness, _make_block_stiffness)


def _make_block_stiffness(spec: Spec) -> Any:
    def coulomb_stiffness(contact):
        n = contact.scale * contact.start_n - contact.stiff_n * contact.velocity_n
        if n <= 0.0:
            return Stiffness(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        e_n, e_t, limit = contact.stiff_n, contact.stiff_t, contact.mu * n
        if limit == 0.0:
            return Stiffness(e_n, 0.0, 0.0, 0.0, 0.0, 0.0)
        one = contact.start_1 - e_t * contact.velocity_1
        two = contact.start_2 - e_t * contact.velocity_2
        r = sqrt(one * one + two * two)
        if r <= limit:
            return Stiffness(e_n, 0.0, 0.0, e_t, 0.0, e_t)
        u, v = one / r, two / r
        along, around = contact.mu * e_n, e_t * (limit / r)
        return Stiffness(e_n, along * u, along * v, around * v * v, -around * u * v, around * u * u)

    return kernel(coulomb_stiffness, spec)


def make_scale_by_coulomb(spec: Spec) -> Any:
    """Return `kernel(rows, source, h)`: the scaled rows are E' times those from `source` on."""

    def scale_by_coulomb(rows, source, h):
        for j in range(DOF):
            n, one, two = rows[source, j], rows[source + T1, j], rows[source + T2, j]
            rows[SCALED, j] = h.nn * n
            rows[SCALED + T1, j] = h.n1 * n + h.t11 * one + h.t12 * two
            rows[SCALED + T2, j] = h.n2 * n + h.t12 * one + h.t22 * two

    return kernel(scale_by_coulomb, spec)


def make_scale_transposed(spec: Spec) -> Any:
    """Return the same kernel for E' transposed."""

    def scale_transposed(rows, source, h):
        for j in range(DOF):
            n, one, two = rows[source, j], rows[source + T1, j], rows[source + T2, j]
            rows[SCALED, j] = h.nn * n + h.n1 * one + h.n2 * two
            rows[SCALED + T1, j] = h.t11 * one + h.t12 * two
            rows[SCALED + T2, j] = h.t12 * one + h.t22 * two

    return kernel(scale_transposed, spec)
