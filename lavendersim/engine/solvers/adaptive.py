"""Projected Gauss-Seidel, and Newton's method where its sweeps converge slowly.

Sweeps are cheap and good at finding who pushes, who sticks and who slides; they carry a load
through a tower, or across a ratio of masses, one contact per sweep. When the changes that sweeps
make shrink so slowly that Newton's steps cost less than the sweeps still needed, Newton's method
takes over (`newton`); sweeps follow, so that impulses end inside their cones. Both costs are
counted in operations, never in time: equal runs take equal decisions.

A solve that would end above its tolerance calls it once more, LAST sweeps before the end, whatever
the sweeps promise: what a step leaves of the error, a cold first one above all, later steps only
spread. In a large heap that is not affordable, and the call takes no step.

Without a tolerance nothing but a sweep that changes nothing ends a solve before its last sweep, and
Newton's method is worth what it would be for a tolerance that is never reached.

A solve that begins near its solution is over after a sweep and pays for nothing else.
"""

from __future__ import annotations

from math import inf, log
from typing import Any

from ..compile import kernel
from ..effects import made_once
from ..residual import make_residual
from ..spec import Spec
from .newton.envelope import allocate_envelope
from .newton.method import make_newton
from .solver import Solver, no_workspace
from .sweep import make_report, make_sweep

# Sweeps between two looks at how fast they converge.
LOOK = 8
# Sweeps that follow the last call of Newton's method.
LAST = 2
# No solve is worth more than so many sweeps.
MOST_SWEEPS = 3000.0
# An end that the sweeps left would not reach is worth so many.
WORTH = 300.0
# Multiplications that take the time of one contact's visit in a sweep.
VISIT = 50.0
# Newton goes on to this share of the tolerance, or resting loads would creep at it.
SHARPNESS = 0.01
# Matrix entries at most (32 MB).
MOST_ENTRIES = 4_000_000


def allocate(spec: Spec, bodies: int, contacts: int) -> Any:
    """Return the arrays this solver works in."""
    if not spec.has("newton"):
        return no_workspace(spec, bodies, contacts)
    rows = 6 * bodies
    return allocate_envelope(bodies, contacts, min(rows * (rows + 1) // 2, MOST_ENTRIES))


def make(spec: Spec):
    """Return `kernel(system, workspace, params, counters, residual_rows)`.

    Writes counters.sweeps, .residual [m/s], .residual_contact and .not_converged of this step.
    """
    record_residuals, record_residual = made_once(spec, "sweep_row")
    sweep, report = make_sweep(spec), make_report(spec)
    residual = make_residual(spec)
    uses_newton = spec.has("newton")
    newton: Any = make_newton(spec) if uses_newton else None
    chooses = spec.has("least_norm")

    def adaptive(system, workspace, params, counters, residual_rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        largest, worst = 0.0, -1
        if record_residuals:
            largest, worst = residual(contacts, count, velocities)
            record_residual(params, counters, residual_rows, 0, largest)
        sweeps, look, pause = 0, LOOK, LOOK
        # None is a number below 0, whose logarithm would be no number of sweeps.
        tolerance = max(params.tolerance, 0.0)
        sharp = SHARPNESS * tolerance
        aim = sharp if counters.sharpen == 1 else tolerance
        counters.sharpen = 0
        measured, sticking_guess = False, True
        earlier = 0.0
        last = params.sweeps - LAST
        while sweeps < params.sweeps:
            greatest = sweep(system, params)
            sweeps += 1
            if chooses:
                counters.unchosen += greatest
            measured = False
            if record_residuals:
                largest, worst = residual(contacts, count, velocities)
                measured = True
                record_residual(params, counters, residual_rows, sweeps, largest)
            # The residual is evaluated when the sweep's own changes say that it may be small.
            over = greatest == 0.0 or greatest != greatest
            if over or greatest <= aim:
                if not measured:
                    largest, worst = residual(contacts, count, velocities)
                    measured = True
                if over or largest <= aim:
                    break
            if uses_newton:
                ends = False
                if sweeps == last and sweeps > LOOK:
                    if not measured:
                        largest, worst = residual(contacts, count, velocities)
                        measured = True
                    ends = not largest <= tolerance
                if sweeps >= look or ends:
                    look = sweeps + pause
                    if earlier > 0.0 or ends:
                        # Sweeps still needed at the rate of the last LOOK of them.
                        needed = MOST_SWEEPS
                        if aim > 0.0 and greatest < earlier and not ends:
                            rate = log(greatest / earlier) / pause
                            needed = min(log(aim / greatest) / rate, MOST_SWEEPS)
                        if sweeps + needed > params.sweeps:
                            needed = max(needed, WORTH)
                        allowance = VISIT * count * needed
                        steps, sticking_guess = newton(
                            system, workspace, sharp, allowance, sticking_guess
                        )
                        counters.newton_steps += steps
                        measured = False
                        if steps > 0:
                            if chooses:
                                counters.unchosen = inf
                            counters.sharpen = 1
                            aim = tolerance
                            # Where this was not the last call, sweeps must prepare the next one.
                            greatest, pause = 0.0, 4 * pause
                    earlier = greatest
        if not measured:
            largest, worst = residual(contacts, count, velocities)
        report(params, counters, sweeps, largest, worst)

    return kernel(adaptive, spec)


# By what bodies allow, it chooses whether to factorise: a matrix alone says nothing of bodies.
SOLVER = Solver(name="adaptive", make=make, allocate=allocate, solves_matrix=False)
