"""The loop of every contact solver: sweep, measure the residual, stop, count and record.

    prepare                     the rows, and what the method carries from sweep to sweep
    sweep                       all contacts once, until the residual is at its aim
    proceed                     between two sweeps: what a method does beside them
    finish                      impulses and velocities back to where the residual reads them
A solver is an `Iteration`, what is its own of these; measuring, stopping, counting and recording
stand here for all of them. The residual costs about a sweep, so it is measured only where the
changes of a sweep, or so many sweeps, say that it may be small enough. A sweep that changes nothing
is the last one: those left would change nothing either. So is one that ends in a NaN. Where cones
change from step to step, impulses that are kept may lie outside by less than the residual shows at
its aim: a sweep, which ends within them, is made all the same.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..compile import kernel
from ..cone import make_are_within
from ..effects import made_once
from ..residual import make_residual
from ..row_terms import row_terms
from ..spec import Spec

# Change of velocity that is none [m/s]. Sweeps that shrink an impulse would go on to the least of
# all numbers, which is another impulse in another unit of mass.
NOTHING = 1e-150


class Carry(NamedTuple):
    """What a method carries from sweep to sweep; those that carry more have a tuple of their own.

    Every one has this field.
    """

    aim: float  # residual at which the solve ends [m/s]; negative: none


class Iteration(NamedTuple):
    """What is a solver's own: kernels, composed for a spec, and when they have to be looked at.

    sweep: kernel(system, workspace, params, counters, carry) -> (greatest change [m/s], carry);
        0 or NaN end the solve, infinity says nothing of the changes.
    prepare: kernel(system, workspace, params, counters) -> carry; None: a `Carry`.
    proceed: kernel(system, workspace, params, counters, carry) -> carry, after every sweep that
        did not end the solve, the last one too; None: nothing.
    finish: kernel(system, workspace, carry), before the residual is measured; None: the sweeps
        keep impulses in the records of contacts, and the velocities consistent with them.
    residual_every: sweeps between two evaluations of the residual, one at the start included; 0:
        only the sweeps' changes say when. Methods whose changes may be small far from the solution
        need it.
    """

    sweep: Any
    prepare: Any = None
    proceed: Any = None
    finish: Any = None
    residual_every: int = 0


def make_solve(spec: Spec, name: str, iteration: Iteration) -> Any:
    """Return `kernel(system, workspace, params, counters, residual_rows)`, called `name`.

    Writes counters.sweeps, .residual [m/s], .residual_contact and .not_converged of this step.
    """
    record_residuals, record_residual = made_once(spec, "sweep_row")
    residual, report = make_residual(spec), _make_report(spec)
    prepare = _make_carry(spec) if iteration.prepare is None else iteration.prepare
    sweep, proceed, finish = iteration.sweep, iteration.proceed, iteration.finish
    proceeds, finishes = proceed is not None, finish is not None
    every, stops_early = iteration.residual_every, iteration.residual_every > 0
    varied = stops_early and (row_terms(spec).varied or row_terms(spec).stretched)
    are_within: Any = make_are_within(spec) if varied else None

    def solve(system, workspace, params, counters, residual_rows):
        contacts, count, velocities = system.contacts, system.count, system.velocities
        carry = prepare(system, workspace, params, counters)
        largest, worst, measured = 0.0, -1, False
        if stops_early or record_residuals:
            largest, worst = residual(contacts, count, velocities)
            measured = True
        if record_residuals:
            record_residual(params, counters, residual_rows, 0, largest)
        sweeps, ends = 0, False
        if stops_early:
            ends = largest <= carry.aim or largest != largest
            if varied:
                ends = ends and are_within(contacts, count)
        while sweeps < params.sweeps and not ends:
            greatest, carry = sweep(system, workspace, params, counters, carry)
            sweeps += 1
            over = greatest <= NOTHING or greatest != greatest
            evaluates = over or greatest <= carry.aim
            if stops_early:
                evaluates = evaluates or record_residuals or sweeps % every == 0
            measured = evaluates or record_residuals
            if measured:
                if finishes:
                    finish(system, workspace, carry)
                largest, worst = residual(contacts, count, velocities)
            if record_residuals:
                record_residual(params, counters, residual_rows, sweeps, largest)
            if evaluates:
                ends = over or largest <= carry.aim or largest != largest
            if proceeds:
                if not ends:
                    carry = proceed(system, workspace, params, counters, carry)
                    measured = False
        if not measured:
            if finishes:
                finish(system, workspace, carry)
            largest, worst = residual(contacts, count, velocities)
        report(params, counters, sweeps, largest, worst)

    solve.__name__ = name  # as `lavender plan` lists them, and as symbols are called
    solve.__qualname__ = f"{make_solve.__name__}.<locals>.{name}"
    return kernel(solve, spec)


def _make_carry(spec: Spec) -> Any:
    def carry_nothing(system, workspace, params, counters):
        return Carry(params.tolerance)

    return kernel(carry_nothing, spec)


def _make_report(spec: Spec) -> Any:
    asked = spec.tolerance

    def report(params, counters, sweeps, residual, worst):
        counters.sweeps = sweeps
        counters.residual = residual
        counters.residual_contact = worst
        counters.not_converged = 0
        if asked:
            if params.tolerance >= 0.0:
                if not residual <= params.tolerance:
                    counters.not_converged = 1

    return kernel(report, spec)
