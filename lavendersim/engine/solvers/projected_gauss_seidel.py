"""Projected Gauss-Seidel: visit rows in order, correct each impulse, keep it pushing.

The update of one contact is in `row_update`. One sweep costs one visit per row; information travels
one contact per visit, so tall stacks need many sweeps. The velocities always carry the impulses
they have been given.
"""

from __future__ import annotations

from math import inf

from ..compile import kernel
from ..effects import has_hook
from ..spec import Spec
from .iteration import Iteration
from .solver import Solver
from .sweep import make_sweep


def make(spec: Spec) -> Iteration:
    """Return the sweeps; where a tolerance is asked for, each ends with a look at the residual."""
    sweep, records = make_sweep(spec), has_hook(spec, "sweep_row")

    def sweep_in_order(system, workspace, params, counters, carry):
        greatest = sweep(system, params)
        if records:
            # Histories have every sweep, those that change nothing too.
            greatest = inf
        return greatest, carry

    return Iteration(kernel(sweep_in_order, spec), residual_every=1 if spec.tolerance else 0)


SOLVER = Solver(name="projected_gauss_seidel", iteration=make)
