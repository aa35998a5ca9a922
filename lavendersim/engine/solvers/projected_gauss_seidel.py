"""Projected Gauss-Seidel: visit rows in order, correct each impulse, keep it pushing.

The update of one contact is in `row_update`. One sweep costs one visit per row; information travels
one contact per visit, so tall stacks need many sweeps. The velocities always carry the impulses
they have been given. A sweep that changes no impulse is the last one: those left would change
nothing either.
"""

from __future__ import annotations

from ..compile import kernel
from ..residual import make_residual
from ..spec import Spec
from .row_update import make_solve_contact_velocity


def make(spec: Spec):
    """Return `kernel(contacts, order, count, bodies, velocities, space, params, counters, rows)`.

    Writes counters.sweeps, .residual [m/s] and .residual_contact of this step.
    """
    solve_contact_velocity = make_solve_contact_velocity(spec)
    residual = make_residual(spec)
    every_sweep = spec.record_residuals or spec.tolerance
    record_residuals = spec.record_residuals
    stop_early = spec.tolerance

    def projected_gauss_seidel(
        contacts, order, count, bodies, velocities, space, params, counters, residual_rows
    ):
        step = counters.step + 1
        wanted = params.residuals_from <= step <= params.residuals_to
        largest, worst = 0.0, -1
        sweeps = 0
        if every_sweep:
            largest, worst = residual(contacts, count, velocities)
        for sweep in range(params.sweeps + 1):
            if record_residuals:
                if wanted:
                    row = residual_rows[counters.residual_rows]
                    row.step, row.sweep, row.residual = step, sweep, largest
                    counters.residual_rows += 1
            if sweep == params.sweeps:
                break
            if stop_early:
                if largest <= params.tolerance:
                    break
            changed = False
            for c in range(count):
                contact = contacts[order[c]]
                va, vb = velocities[contact.a], velocities[contact.b]
                if solve_contact_velocity(contact, va, vb) != 0.0:
                    changed = True
            sweeps += 1
            if not record_residuals:
                # Nothing changed, so nothing would change in the sweeps that are left.
                if not changed:
                    break
            if every_sweep:
                largest, worst = residual(contacts, count, velocities)
        if not every_sweep:
            largest, worst = residual(contacts, count, velocities)
        counters.sweeps = sweeps
        counters.residual = largest
        counters.unsolved = 0
        if stop_early:
            if params.tolerance >= 0.0:
                if not largest <= params.tolerance:
                    counters.unsolved = 1
        counters.residual_contact = worst

    return kernel(projected_gauss_seidel, spec)
