"""Step doubling: substeps made whole and in halves, and which of them is kept (`error_control`).

begin     keep the state that a substep begins with, and choose its length
note_part where a part of the whole ends before it does: an impact, or sliding that stops
end_span  when the whole of it, or what comes next of its halves, is made: what comes next
abandon   back to where the substep begins, for a step that its caller begins again
"""

from __future__ import annotations

from math import sqrt
from typing import Any, Final, NamedTuple

import numpy as np

from .compile import kernel
from .drives import MOMENT, NEAR, make_begin_of_part, make_next_knot
from .effects import has_hook, made_by
from .error_estimate import PATH, make_add_paths, make_estimate
from .hidden_bends import make_note_loads
from .record_layout import cache_dtype, step_row_dtype
from .records import COUNTERS, Field, dtype
from .row_terms import row_terms
from .spec import Spec
from .step_terms import step_terms

# What is being made of a substep. Of the whole every part is made in halves, or it would be the
# same in both and have no estimate: up to the middles of its parts, one by one, and the rest.
NOTHING, WHOLE, FIRST_HALF, SECOND_HALF = 0, 1, 2, 3
# What `end_span` says.
GO_ON, STEP_ENDS, MISSED = 0, 1, 2
# Estimates add up as if errors never cancelled: those of smooth motion may be so many times the
# accuracy in all, and kinks may add it once more.
CANCELS = 3.0
# A substep is proposed with a little less than the length that would be just right; it grows and
# shrinks by no more than these factors.
CAUTION, SHRINK, GROW = 0.9, 0.1, 4.0
# Share of what is unspent that one substep may spend beyond its own.
AT_ONCE = 1.0 / 16.0

# Parts of a substep that are halved, at most: shorter ones are halved with what follows. All that
# is not halved then has at most 1/16² of the error of a whole substep.
MOST_PARTS: Final = 16

# Substeps of one step. Rolling and bouncing at accuracies of 1e-6 take some 500 in 1/60 s.
MOST_SUBSTEPS: Final = 4096

CONTROL: Final[list[Field]] = [
    ("phase", "i8"),  # NOTHING, WHOLE, ...
    ("start", "f8"),  # of the substep, from the start of the step [s]
    ("length", "f8"),  # of the substep [s]
    ("end", "f8"),  # of the substep, from the start of the step [s]
    ("until", "f8"),  # end of what is being made, from the start of the step [s]
    ("cuts", "i8"),  # of the whole, where its parts end that are halved
    ("halved", "i8"),  # parts whose middle has been reached, or is on the way
    ("proposed", "f8"),  # length of the next substep; 0: as long as can be [s]
    ("smooth", "f8"),  # length that is tried again behind a kink [s]
    ("before", "f8"),  # time of the run when the step begins [s]
    ("spent", "f8"),  # estimated error of the run so far, relative [-]
    ("error", "f8"),  # of the substep that was made last [-]
]


class Control(NamedTuple):
    """What error control keeps: of the run, and of the start of a substep; n bodies, m contacts."""

    record: np.ndarray  # (1,) CONTROL
    paths: np.ndarray  # (n,) PATH
    bodies: np.ndarray  # (n,) at the start of the substep
    velocities: np.ndarray  # (n,)
    cache: np.ndarray  # (m,)
    counters: np.ndarray  # (1,)
    row: np.ndarray  # (1,) of the log; none where nothing is logged
    whole: np.ndarray  # (n,) bodies that the whole substep leads to
    differences: np.ndarray  # (n,) velocities that it leads to, then what they differ by
    middle: np.ndarray  # (n,) velocities where its first half ends
    cuts: np.ndarray  # (MOST_PARTS,) f8, ends of its parts, from the start of the step [s]
    unparted: Any  # (n,) i8, as MOTION has it at the start of the substep; () without joints


def keeps_unparted(spec: Spec) -> bool:
    """Whether parts know from those before whether joints stayed together (`midpoint_rows`)."""
    return row_terms(spec).bilateral and step_terms(spec).centred


def allocate_control(spec: Spec, bodies: np.ndarray, velocities: np.ndarray, capacity: int) -> Any:
    """Return the memory of error control for so many contacts; () without it."""
    if not step_terms(spec).substeps:
        return ()
    return Control(
        record=np.zeros(1, dtype(CONTROL)),
        paths=np.zeros(len(bodies), dtype(PATH)),
        bodies=np.zeros_like(bodies),
        velocities=np.zeros_like(velocities),
        cache=np.zeros(capacity if has_hook(spec, "match") else 0, cache_dtype(spec)),
        counters=np.zeros(1, dtype(COUNTERS)),
        row=np.zeros(1 if has_hook(spec, "log_step") else 0, step_row_dtype(spec)),
        whole=np.zeros_like(bodies),
        differences=np.zeros_like(velocities),
        middle=np.zeros_like(velocities),
        cuts=np.zeros(MOST_PARTS),
        unparted=np.zeros(len(bodies), np.int64) if keeps_unparted(spec) else (),
    )


def with_capacity(control: Any, capacity: int) -> Any:
    """Return the memory with room for so many contacts, between substeps."""
    if not control or not len(control.cache):
        return control
    return control._replace(cache=np.zeros(capacity, control.cache.dtype))


def make_begin_substep(spec: Spec) -> Any:
    """Return `kernel(state, params, counters, rows)`: keep the state, choose a length.

    rows: of steps, in the log.
    """
    warms, logs = has_hook(spec, "match"), has_hook(spec, "log_step")
    driven, joined = bool(made_by(spec, "drive")), keeps_unparted(spec)
    begin_of_part: Any = make_begin_of_part(spec) if driven else None
    next_knot: Any = make_next_knot(spec) if driven else None

    def begin_substep(state, params, counters, rows):
        control = state.control
        record = control.record[0]
        if counters.parts == 0:
            record.start = 0.0
        for i in range(state.bodies.shape[0]):
            control.bodies[i] = state.bodies[i]
            control.velocities[i] = state.velocities[i]
            if joined:
                control.unparted[i] = state.motion[i].unparted
        if warms:
            for c in range(counters.cached):
                control.cache[c] = state.cache[c]
        control.counters[0] = counters
        if logs:
            control.row[0] = rows[counters.step_rows]
        left, until = params.timestep - record.start, params.timestep
        if driven:  # none is of second order where what acts on bodies bends or jumps
            now = begin_of_part(params, counters)
            knot = next_knot(state.drives, now, now + left)
            if knot < now + left - NEAR * (MOMENT + now):
                left, until = knot - now, record.start + (knot - now)
        record.phase, record.length, record.until = WHOLE, left, until
        shortest = params.smallest_timestep
        if 0.0 < record.proposed < left and shortest < left:
            # Two of nearly equal lengths rather than a long one and what remains.
            record.length = max(min(record.proposed, 0.5 * left), shortest)
            record.until = record.start + record.length
        record.end, record.cuts, record.halved = record.until, 0, 0

    return kernel(begin_substep, spec)


def make_note_part(spec: Spec) -> Any:
    """Return `kernel(control, elapsed)`: a part ends there, before what is being made does."""

    def note_part(control, elapsed):
        record = control.record[0]
        if record.phase == WHOLE:
            begin = record.start
            if record.cuts > 0:
                begin = control.cuts[record.cuts - 1]
            if MOST_PARTS * (elapsed - begin) > record.length:
                control.cuts[record.cuts] = elapsed
                record.cuts += 1

    return kernel(note_part, spec)


def make_next_middle(spec: Spec) -> Any:
    """Return `kernel(control)`: on to the middle of the next part of the whole."""

    def next_middle(control):
        record = control.record[0]
        if record.cuts == 0:
            record.until = record.start + 0.5 * record.length
        else:
            begin, end = record.start, record.end
            if record.halved > 0:
                begin = control.cuts[record.halved - 1]
            if record.halved < record.cuts:
                end = control.cuts[record.halved]
            record.until = 0.5 * (begin + end)
        record.halved += 1

    return kernel(next_middle, spec)


def make_restore(spec: Spec) -> Any:
    """Return `kernel(state, params, counter, rows)`: all as the substep began."""
    warms, logs = has_hook(spec, "match"), has_hook(spec, "log_step")
    sleeps, turns = has_hook(spec, "update_sleeping"), step_terms(spec).turns
    joined = keeps_unparted(spec)

    def wake(kept, body):
        # Who woke in the substep is awake when it is made again.
        if kept.asleep == 1 and body.asleep == 0:
            kept.asleep, kept.rest, kept.inv_m = 0, 0.0, kept.own_inv_m
            if turns:
                kept.inv_ix, kept.inv_iy, kept.inv_iz = (
                    kept.own_inv_ix,
                    kept.own_inv_iy,
                    kept.own_inv_iz,
                )

    # A plain function among what a kernel names is no constant: the whole kernel would have no key,
    # and be compiled again by every process.
    keep_awake: Any = kernel(wake, spec) if sleeps else None

    def restore(state, params, counter, rows):
        control = state.control
        for i in range(state.bodies.shape[0]):
            if sleeps:
                keep_awake(control.bodies[i], state.bodies[i])
            state.bodies[i] = control.bodies[i]
            state.velocities[i] = control.velocities[i]
            if joined:
                state.motion[i].unparted = control.unparted[i]
        counter[0] = control.counters[0]
        if warms:
            for c in range(counter[0].cached):
                state.cache[c] = control.cache[c]
        if logs:
            rows[counter[0].step_rows] = control.row[0]
        params.dt = params.timestep

    return kernel(restore, spec)


def make_abandon(spec: Spec) -> Any:
    """Return `kernel(state, params, counter, rows)`: a substep that is begun anew."""
    restore = make_restore(spec)

    def abandon(state, params, counter, rows):
        record = state.control.record[0]
        if record.phase != NOTHING:
            restore(state, params, counter, rows)
        record.phase = NOTHING

    return kernel(abandon, spec)


def make_judge(spec: Spec) -> Any:
    """Return `kernel(record, params, error, floor) -> whether it is kept`; proposes the next.

    floor: below it the estimate says nothing.
    """

    def judge(record, params, error, floor):
        done = (record.before + record.end) / params.duration
        own = CANCELS * params.accuracy * record.length / params.duration
        unspent = params.accuracy * (1.0 + CANCELS * done) - record.spent
        own = max(own, floor)
        allowed = max(own, AT_ONCE * unspent)
        record.error = error
        factor = GROW
        if error > 0.0:
            factor = min(CAUTION * sqrt(own / error), GROW)
        length = factor * record.length
        if error <= own:
            # One that the end of the step cut short says nothing against a longer one.
            if factor >= 1.0 and record.length < record.proposed:
                length = max(length, record.proposed)
            record.proposed = record.smooth = length
            return True
        if error <= allowed:
            # Behind a kink, for which it was shortened, the next is tried as long as before; where
            # that fails it was no kink.
            kink = record.length < 0.5 * record.smooth
            record.proposed = record.smooth if kink else length
            record.smooth = record.length
            return True
        factor = SHRINK
        if error - error == 0.0:
            factor = max(SHRINK, min(CAUTION * sqrt(allowed / error), 0.5))
        record.proposed = factor * record.length
        return False

    return kernel(judge, spec)


def make_end_span(spec: Spec) -> Any:
    """Return `kernel(state, count, params, counter, rows, failed) -> GO_ON, STEP_ENDS or MISSED`.

    count: of contacts of the part that ends; failed: a body is no longer finite, or turns too far.
    """
    restore, judge, next_middle = make_restore(spec), make_judge(spec), make_next_middle(spec)
    estimate, add_paths = make_estimate(spec), make_add_paths(spec)
    touches = spec.touches
    note_loads: Any = make_note_loads(spec) if touches else None

    def end_half(counters):
        counters.part_unordered |= counters.unordered
        counters.spent, counters.unordered, counters.plastic = 0, 0, 0

    end_half = kernel(end_half, spec)

    def end_span(state, count, params, counter, rows, failed):
        control, counters = state.control, counter[0]
        record = control.record[0]
        counters.elapsed = record.until
        if not failed:
            if record.phase == WHOLE:
                for i in range(state.bodies.shape[0]):
                    control.whole[i] = state.bodies[i]
                    control.differences[i] = state.velocities[i]
                restore(state, params, counter, rows)
                record.phase = FIRST_HALF
                next_middle(control)
                return GO_ON
            if record.phase == FIRST_HALF:
                if record.halved <= record.cuts:
                    next_middle(control)
                else:
                    record.phase, record.until = SECOND_HALF, record.end
                    for i in range(state.bodies.shape[0]):
                        control.middle[i] = state.velocities[i]
                    if touches:
                        note_loads(state.contacts, count, control.paths, params.dt)
                end_half(counters)
                return GO_ON
        record.phase = NOTHING
        error, floor, worst = np.inf, 0.0, counters.body
        if not failed:
            left = params.duration - (record.before + record.end)
            ordered = counters.unordered == 0 and counters.part_unordered == 0
            error, floor, worst = estimate(state, count, left, params, counters.residual, ordered)
        # A step that has had them all is as far from its end as ever: chaos takes no fewer.
        exhausted = counters.substeps >= MOST_SUBSTEPS
        if judge(record, params, error, floor) and not exhausted:
            half = 0.5 * record.length
            add_paths(state.bodies, state.velocities, control.bodies, control.paths, half)
            record.spent += max(error - floor, 0.0)
            record.start = record.end
            end_half(counters)
            counters.shortest = half if counters.substeps == 0 else min(counters.shortest, half)
            counters.substeps += 2
            counters.estimated_error += error
            if record.start < params.timestep:
                return GO_ON
            counters.unordered = counters.part_unordered
            record.before += params.timestep
            return STEP_ENDS
        restore(state, params, counter, rows)
        if exhausted or record.length <= params.smallest_timestep:
            record.proposed, counters.body = record.length, worst
            return MISSED
        counters.rejected += 1
        return GO_ON

    return kernel(end_span, spec)
