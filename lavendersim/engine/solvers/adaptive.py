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
from typing import Any, NamedTuple

from ..compile import kernel
from ..residual import make_residual
from ..spec import Spec
from .iteration import Iteration
from .newton.envelope import allocate_envelope
from .newton.method import make_newton
from .solver import Solver, no_workspace
from .sweep import make_sweep

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


class Adaption(NamedTuple):
    """What the choice between sweeps and Newton's method carries, see `iteration.Carry`."""

    aim: float
    sweeps: int  # made
    greatest: float  # change of the last sweep [m/s]
    earlier: float  # the same at the last look; 0: there was none [m/s]
    look: int  # sweeps made at the next look at how fast they converge
    pause: int  # sweeps between two of them
    sticking_guess: bool  # see `newton.method`


def make(spec: Spec) -> Iteration:
    """Return the sweeps, and Newton's method between them."""
    sweep = make_sweep(spec)
    chooses = spec.has("least_norm")

    def prepare(system, workspace, params, counters):
        # None is a number below 0, whose logarithm would be no number of sweeps.
        aim = max(params.tolerance, 0.0)
        if counters.sharpen == 1:
            aim *= SHARPNESS
        counters.sharpen = 0
        return Adaption(aim, 0, 0.0, 0.0, LOOK, LOOK, True)

    def sweep_and_count(system, workspace, params, counters, carry):
        greatest = sweep(system, params)
        if chooses:
            counters.unchosen += greatest
        made = carry.sweeps + 1
        return greatest, Adaption(
            carry.aim, made, greatest, carry.earlier, carry.look, carry.pause, carry.sticking_guess
        )

    return Iteration(
        kernel(sweep_and_count, spec),
        prepare=kernel(prepare, spec),
        proceed=_make_proceed(spec) if spec.has("newton") else None,
    )


def _make_proceed(spec: Spec) -> Any:
    newton, residual, chooses = make_newton(spec), make_residual(spec), spec.has("least_norm")

    def proceed(system, workspace, params, counters, carry):
        tolerance = max(params.tolerance, 0.0)
        sweeps, greatest, aim = carry.sweeps, carry.greatest, carry.aim
        pause, sticking_guess = carry.pause, carry.sticking_guess
        ends = False
        if sweeps == params.sweeps - LAST and sweeps > LOOK:
            largest, _ = residual(system.contacts, system.count, system.velocities)
            ends = not largest <= tolerance
        if sweeps < carry.look and not ends:
            return carry
        look = sweeps + pause
        if carry.earlier > 0.0 or ends:
            # Sweeps still needed at the rate of the last LOOK of them.
            needed = MOST_SWEEPS
            if aim > 0.0 and greatest < carry.earlier and not ends:
                rate = log(greatest / carry.earlier) / pause
                needed = min(log(aim / greatest) / rate, MOST_SWEEPS)
            if sweeps + needed > params.sweeps:
                needed = max(needed, WORTH)
            allowance = VISIT * system.count * needed
            steps, sticking_guess = newton(
                system, workspace, SHARPNESS * tolerance, allowance, sticking_guess
            )
            counters.newton_steps += steps
            if steps > 0:
                if chooses:
                    counters.unchosen = inf
                counters.sharpen = 1
                aim = tolerance
                # Where this was not the last call, sweeps must prepare the next one.
                greatest, pause = 0.0, 4 * pause
        return Adaption(aim, sweeps, greatest, greatest, look, pause, sticking_guess)

    return kernel(proceed, spec)


# By what bodies allow, it chooses whether to factorise: a matrix alone says nothing of bodies.
SOLVER = Solver(name="adaptive", iteration=make, allocate=allocate, solves_matrix=False)
