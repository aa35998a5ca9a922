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
from .solver import Solver
from .sweep import make_account, make_note, make_sweep


def make(spec: Spec):
    """Return `kernel(contacts, order, count, bodies, velocities, space, params, counters, rows)`.

    Writes counters.sweeps, .residual [m/s] and .residual_contact of this step.
    """
    sweep, note, account = make_sweep(spec), make_note(spec), make_account(spec)
    residual = make_residual(spec)
    every_sweep = spec.has("residual_log") or spec.tolerance
    record_residuals = spec.has("residual_log")
    stop_early = spec.tolerance

    def projected_gauss_seidel(
        contacts, order, count, bodies, velocities, space, params, counters, residual_rows
    ):
        largest, worst = 0.0, -1
        sweeps = 0
        if every_sweep:
            largest, worst = residual(contacts, count, velocities)
        while True:
            if record_residuals:
                note(params, counters, residual_rows, sweeps, largest)
            if sweeps == params.sweeps:
                break
            if stop_early:
                if largest <= params.tolerance:
                    break
            greatest = sweep(contacts, order, count, velocities, params)
            sweeps += 1
            if not record_residuals:
                # Nothing changed, so nothing would change in the sweeps that are left.
                if greatest == 0.0:
                    break
            if every_sweep:
                largest, worst = residual(contacts, count, velocities)
        if not every_sweep:
            largest, worst = residual(contacts, count, velocities)
        account(params, counters, sweeps, largest, worst)

    return kernel(projected_gauss_seidel, spec)


SOLVER = Solver(name="projected_gauss_seidel", make=make)
