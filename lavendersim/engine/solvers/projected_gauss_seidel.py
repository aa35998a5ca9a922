"""Projected Gauss-Seidel: visit rows in order, correct each impulse, keep it pushing.

The update of one contact is in `row_update`. One sweep costs one visit per row; information travels
one contact per visit, so tall stacks need many sweeps. The velocities always carry the impulses
they have been given. A sweep that changes no impulse is the last one: those left would change
nothing either.
"""

from __future__ import annotations

from ..compile import kernel
from ..effects import made_once
from ..residual import make_residual
from ..spec import Spec
from .solver import Solver
from .sweep import make_report, make_sweep


def make(spec: Spec):
    """Return `kernel(system, workspace, params, counters, residual_rows)`.

    Writes counters.sweeps, .residual [m/s], .residual_contact and .not_converged of this step.
    """
    sweep, report = make_sweep(spec), make_report(spec)
    residual = make_residual(spec)
    record_residuals, record_residual = made_once(spec, "sweep_row")
    every_sweep = record_residuals or spec.tolerance
    stop_early = spec.tolerance

    def projected_gauss_seidel(system, workspace, params, counters, residual_rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        largest, worst = 0.0, -1
        sweeps = 0
        if every_sweep:
            largest, worst = residual(contacts, count, velocities)
        while True:
            if record_residuals:
                record_residual(params, counters, residual_rows, sweeps, largest)
            if sweeps == params.sweeps:
                break
            if stop_early:
                if largest <= params.tolerance:
                    break
            greatest = sweep(system, params)
            sweeps += 1
            if not record_residuals:
                # Nothing changed, so nothing would change in the sweeps that are left.
                if greatest == 0.0:
                    break
            if every_sweep:
                largest, worst = residual(contacts, count, velocities)
        if not every_sweep:
            largest, worst = residual(contacts, count, velocities)
        report(params, counters, sweeps, largest, worst)

    return kernel(projected_gauss_seidel, spec)


SOLVER = Solver(name="projected_gauss_seidel", make=make)
