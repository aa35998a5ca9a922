"""Projected Gauss-Seidel, and Newton's method where its sweeps converge slowly.

Sweeps are cheap and good at finding who pushes, who sticks and who slides; they carry a load
through a tower, or across a ratio of masses, one contact per sweep. When the changes that sweeps
make shrink so slowly that Newton's steps cost less than the sweeps still needed, Newton's method
takes over (`newton`); sweeps follow, so that impulses end inside their cones. Both costs are
counted in operations, never in time: equal runs take equal decisions.

A solve that would end above its tolerance calls it once more, LAST sweeps before the end, whatever
the sweeps promise: what a step leaves of the error, a cold first one above all, later steps only
spread. What that call leaves above the tolerance goes to `newton.alart_curnier`, after the last
sweep again, and what that leaves begins once more from inside the cones, `newton.begin_again`. In
a large heap that is not affordable, and the call takes no step.

Without a tolerance nothing but a sweep that changes nothing ends a solve before its last sweep, and
Newton's method is worth what it would be for a tolerance that is never reached.

A solve that begins near its solution is over after a sweep and pays for nothing else. One of many
contacts that is given more than PLAIN_SWEEPS begins the others from several together
(`packed.extrapolation`).
"""

from __future__ import annotations

from math import inf, log
from typing import Any, NamedTuple

from ..compile import kernel
from ..effects import has_hook
from ..effects.anderson_acceleration import PLAIN_SWEEPS
from ..residual import make_residual
from ..row_terms import row_terms
from ..spec import Spec
from .iteration import Iteration
from .newton.alart_curnier import make_alart_curnier
from .newton.begin_again import make_begin_again
from .newton.envelope import allocate_envelope
from .newton.factor import allocate_factor
from .newton.method import FEWEST_STEPS, MOST_STEPS, make_newton, make_step_cost
from .newton.rounds import SOFTEST
from .packed.extrapolation import forget, make_extrapolate
from .packed.late import FAR, FIRST, Packing, make_sweep_late, packs_late
from .packed.layout import PackedContacts, allocate_packed
from .packed.sweep import are_blocks
from .solver import Solver, no_workspace
from .sweep import make_sweep

# Sweeps between two looks at how fast they converge.
LOOK = 8
# Sweeps that follow the last call of Newton's method.
LAST = 2
# One call of Newton's method is worth no more than so many sweeps.
MOST_SWEEPS = 3000.0
# An end that the sweeps left would not reach is worth so many.
WORTH = 300.0
# Steps on Coulomb's law itself, to one of the convex rounds before; each takes twice its time.
MORE_STEPS = 2.5
# Multiplications that take the time of one contact's visit in a sweep.
VISIT = 50.0
# Newton goes on to this share of the tolerance, or resting loads would creep at it.
SHARPNESS = 0.01
# Matrix entries at most: 32 MB, and as much for those above the diagonal of `lu`.
MOST_ENTRIES = 4_000_000


class Swept(NamedTuple):
    """What sweeps work in where no solve is finished by Newton's method."""

    packed: PackedContacts


def allocate(spec: Spec, bodies: int, contacts: int) -> Any:
    """Return the arrays this solver works in."""
    packed = allocate_packed(spec, bodies, contacts, eight=True) if packs_late(spec) else None
    if spec.has("newton"):
        rows = 6 * bodies
        entries = min(rows * (rows + 1) // 2, MOST_ENTRIES)
        upper = entries if row_terms(spec).frictional else 0
        inside = contacts if row_terms(spec).frictional else 0
        sweeping = () if packed is None else packed
        factor = allocate_factor(spec, bodies, contacts, entries)
        return allocate_envelope(
            bodies, contacts, entries, sweeping, upper, inside, elimination=factor
        )
    return no_workspace(spec, bodies, contacts) if packed is None else Swept(packed)


class Adaption(NamedTuple):
    """What the choice between sweeps and Newton's method carries, see `iteration.Carry`."""

    aim: float
    packing: Packing
    sweeps: int  # made
    greatest: float  # change of the last sweep [m/s]
    earlier: float  # the same at the last look; 0: there was none [m/s]
    look: int  # sweeps made at the next look at how fast they converge
    pause: int  # sweeps between two of them
    sticking_guess: bool  # see `newton.method`
    unknowns: int  # bodies of Newton's method; -1: not laid out in this solve
    cost: float  # of a step [multiplications]


def _mixes(spec: Spec) -> bool:
    return spec.has("anderson_acceleration") and packs_late(spec) and are_blocks(spec)


def make(spec: Spec) -> Iteration:
    """Return the sweeps, and Newton's method between them."""
    packs, chooses = packs_late(spec), has_hook(spec, "choose_impulses")
    looks = spec.has("newton")
    mixes = _mixes(spec)
    extrapolate: Any = make_extrapolate(spec) if mixes else None
    put_back: Any = None
    sweep: Any = None
    if packs:
        sweep, put_back = make_sweep_late(spec)
    else:
        sweep = make_sweep(spec)

    def prepare(system, workspace, params, counters):
        # None is a number below 0, whose logarithm would be no number of sweeps.
        aim = max(params.tolerance, 0.0)
        if counters.sharpen == 1:
            aim *= SHARPNESS
        counters.sharpen = 0
        if mixes:
            forget(workspace.packed)
        return Adaption(aim, Packing(FIRST, 0, 0), 0, 0.0, 0.0, LOOK, LOOK, True, -1, 0.0)

    def sweep_and_count(system, workspace, params, counters, carry):
        packing, sweeps = carry.packing, carry.sweeps
        if mixes:
            left = params.sweeps - LAST - sweeps
            if sweeps >= PLAIN_SWEEPS and left >= 0 and packing.slots > 0 and packing.ahead == 0:
                extrapolate(workspace.packed, packing.slots, left == 0)
        if packs:
            most = params.sweeps - sweeps
            if looks:
                if most > LAST:
                    most -= LAST
                most = min(most, carry.look - sweeps)
            elif mixes:
                if most > LAST:
                    most -= LAST
            # What rests lets go of its first change in the second sweep.
            far = sweeps > FIRST and carry.greatest > FAR * carry.aim
            if mixes:  # each sweep begins from those before it
                far = far and sweeps < PLAIN_SWEEPS
            greatest, change, packing = sweep(system, workspace.packed, params, packing, most, far)
        else:
            greatest = sweep(system, params)
            change = greatest
        if chooses:
            counters.unchosen += change
        return greatest, Adaption(
            carry.aim, packing, sweeps + 1, change, carry.earlier, carry.look,
            carry.pause, carry.sticking_guess, carry.unknowns, carry.cost,
        )  # fmt: skip

    def finish(system, workspace, carry):
        put_back(system, workspace.packed, carry.packing)

    return Iteration(
        kernel(sweep_and_count, spec),
        prepare=kernel(prepare, spec),
        proceed=_make_proceed(spec, put_back) if spec.has("newton") else None,
        finish=kernel(finish, spec) if packs else None,
    )


def _make_proceed(spec: Spec, put_back: Any) -> Any:
    newton, residual = make_newton(spec), make_residual(spec)
    step_cost = make_step_cost(spec)
    chooses = has_hook(spec, "choose_impulses")
    packs, slides = put_back is not None, row_terms(spec).frictional
    mixes = _mixes(spec)
    alart_curnier: Any = make_alart_curnier(spec)
    begin_again: Any = make_begin_again(spec)

    def proceed(system, workspace, params, counters, carry):
        tolerance = max(params.tolerance, 0.0)
        sweeps, greatest, aim, packing = carry.sweeps, carry.greatest, carry.aim, carry.packing
        pause, sticking_guess = carry.pause, carry.sticking_guess
        unknowns, cost = carry.unknowns, carry.cost
        ends, over = False, False
        if slides:
            over = sweeps == params.sweeps
        affordable = True  # by what is known of a step's cost, however much it is worth
        if unknowns >= 0:
            affordable = VISIT * system.count * MOST_SWEEPS >= FEWEST_STEPS * cost
        if (sweeps == params.sweeps - LAST or over) and sweeps > LOOK and affordable:
            if packs:
                put_back(system, workspace.packed, packing)
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
            if unknowns < 0:
                unknowns, cost = step_cost(system, workspace)
            most = min(float(MOST_STEPS), VISIT * system.count * needed / cost)
            if most >= FEWEST_STEPS:
                if packs:
                    put_back(system, workspace.packed, packing)
                    packing = Packing(FIRST, 0, 0)  # few sweeps follow
                    if mixes:
                        forget(workspace.packed)
                steps = 0
                if not (over and ends):
                    steps, sticking_guess = newton(
                        system, workspace, unknowns, most, SHARPNESS * tolerance, sticking_guess
                    )
                if slides:
                    if ends:
                        most *= MORE_STEPS
                        residuals = SHARPNESS * tolerance, tolerance
                        steps += alart_curnier(
                            system, workspace, unknowns, most, residuals, SOFTEST
                        )
                        if over:
                            steps += begin_again(
                                system, workspace, unknowns, most, residuals, params
                            )
                counters.newton_steps += steps
                if steps > 0:
                    if chooses:
                        counters.unchosen = inf
                    counters.sharpen = 1
                    aim = tolerance
                    # Where this was not the last call, sweeps must prepare the next one.
                    greatest, pause = 0.0, 4 * pause
        return Adaption(
            aim, packing, sweeps, greatest, greatest, look, pause, sticking_guess, unknowns, cost
        )

    return kernel(proceed, spec)


# By what bodies allow, it chooses whether to factorise: a matrix alone says nothing of bodies.
SOLVER = Solver(name="adaptive", iteration=make, allocate=allocate, solves_matrix=False)
