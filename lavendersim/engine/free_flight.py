"""The row of a contact that a body flies past: it asks for no push."""

from __future__ import annotations

from typing import Any

from .approach import CREEP
from .compile import inner, kernel
from .row_terms import row_terms
from .spec import Spec

# Share of the velocity, and of ROUNDED, that such a row leaves as room: round-off must not push
# what flies, for what a contact pushes is carried by the velocity of the step's end [-].
LOOSE = 1e-12
# Speed whose digits a velocity near 0 has by what it is the difference of [m/s].
ROUNDED = 1.0


@inner
def target_of_flight(v_n):
    """Return the target [m/s] that holds without a push; v_n: normal velocity before the solve."""
    return -v_n + LOOSE * (ROUNDED + abs(v_n))


def make_widen(spec: Spec) -> Any:
    """Return `kernel(contact, params)`, of a row at the start: by what turning opens of its gap.

    The gap at the end is phi + dt (n . J(q_0) v + b), v: v_1, or of what flies the mean. Surfaces
    that curve away from each other may come nearer by their rate at the start and yet not meet. Nor
    do surfaces that touch and part, if the mean of free flight leaves a gap, however fast they near
    each other as it ends.
    """

    bilateral = row_terms(spec).bilateral

    def widen(contact, params):
        if bilateral:
            if contact.bilateral == 1:
                return
        opens = contact.middle_n - contact.begin_n
        if contact.phi <= params.slop and contact.begin_n > CREEP:
            mean = contact.v_n_pre - 0.5 * contact.dv_n
            if contact.phi + mean * params.dt > params.slop:
                contact.target = max(contact.target, target_of_flight(contact.v_n_pre))
        if contact.phi > params.slop and opens > 0.0:
            mean = contact.v_n_pre - 0.5 * contact.dv_n
            if contact.phi + (mean + opens) * params.dt > -params.slop:
                contact.target = max(contact.target, target_of_flight(contact.v_n_pre))
            contact.target += opens

    return kernel(widen, spec)
