"""One sweep over the contacts in their order, as solvers by sweeps share it."""

from __future__ import annotations

from typing import Any

from .. import ordering
from ..compile import kernel
from ..prefetch import AHEAD, prefetch
from ..slabs import FEWEST_CONTACTS, has_slabs
from ..spec import Spec
from .row_update import make_solve_contact_velocity


def make_sweep(spec: Spec):
    """Return `kernel(system, params) -> greatest change` [m/s].

    Symmetric sweeps go there and back: each leaves the order of the next one turned round.
    """
    solve_contact_velocity = make_solve_contact_velocity(spec)
    symmetric = spec.order == "symmetric"
    asks = has_slabs(spec)  # its scenes may be larger than the caches
    turn_round: Any = ordering.make_turn_round(spec) if symmetric else None

    def sweep(system, params):
        contacts, order, velocities = system.contacts, system.order, system.velocities
        greatest = 0.0
        for c in range(system.count):
            if asks:
                if system.count >= FEWEST_CONTACTS:
                    prefetch(contacts, order[min(c + AHEAD, system.count - 1)])
            contact = contacts[order[c]]
            change = solve_contact_velocity(contact, contacts, velocities, params)
            # A NaN is greater than anything.
            if change > greatest or change != change:
                greatest = change
        if symmetric:
            turn_round(order, system.count)
        return greatest

    return kernel(sweep, spec)
