"""Sweeps over packed contacts that the members of a team share (`team`), to the bits of one thread.

A stage is a run of groups of which no two share a movable body: a colour of the order, or what is
left of it where contacts of one colour are many. Its groups are dealt out in pieces, and the next
stage begins when all are made. Stages of few groups are one piece, several together: dealing them
out takes longer. Slab by slab colours are small; there sweeps that follow each other (`sweep`) are
made side by side, and each run is meant for the same member in all of them.
"""

from __future__ import annotations

from typing import Any

from ...atomics import fetch_add, load
from ...compile import inner, kernel
from ...effects.packed_sweeps import SHARED_COLOUR, SHARED_SWEEP
from ...kernel_clock import nanoseconds
from ...spec import Spec
from ...team import (
    FOLLOW,
    FORK,
    LEAVE,
    MEMBERS,
    MOST,
    PUSH,
    SIZE,
    SWEEP,
    arguments,
    await_fork,
    await_pieces,
    claim,
    finish,
    fork,
    greatest_of,
    is_worth_it,
    note_time,
    size_of,
)
from .lane_memory import STRIDE
from .lanes import WIDTH
from .layout import HEAD, RUN

# Groups from which on a stage is shared, and those in shared stages from which on a sweep is.
FEWEST_GROUPS, WORTH_IT = SHARED_COLOUR // WIDTH, SHARED_SWEEP // WIDTH
# Pieces of a shared stage for each member: what one that comes late has not claimed others make.
EACH = 2


@inner
def _distance(reach, size):
    """Return how many runs a sweep is behind the last: each run is one member's in all of them."""
    distance = reach + 1
    while True:
        a, b = distance, size
        while b > 0:
            a, b = b, a % b
        if a == 1:
            return distance
        distance += 1


def make_find_stages(spec: Spec) -> Any:
    """Return `kernel(packed, slots)`: fills `packed.stages`.

    A stage is worth a word: twice the group that it begins with, and 1 where it is shared.
    """

    def find_stages(packed, slots):
        stages, last_of, groups = packed.stages, packed.group_of, slots // WIDTH
        for body in range(last_of.shape[0]):
            last_of[body] = -1
        count, begin, shared = 0, 0, 0
        stages[0] = 0
        for g in range(groups + 1):
            apart = g == groups
            if not apart:
                for slot in range(g * WIDTH, (g + 1) * WIDTH):
                    for place in (packed.first[slot], packed.second[slot]):
                        if place > 0 and last_of[place // STRIDE - HEAD] >= begin:
                            apart = True
            if apart and g > begin:
                many = g - begin >= FEWEST_GROUPS
                if many or count == 0 or stages[count - 1] % 2 == 1:
                    stages[count] = 2 * begin + (1 if many else 0)
                    count += 1
                if many:
                    shared += g - begin
                begin = g
            if g < groups:
                for slot in range(g * WIDTH, (g + 1) * WIDTH):
                    for place in (packed.first[slot], packed.second[slot]):
                        if place > 0:
                            last_of[place // STRIDE - HEAD] = g
        stages[count] = 2 * groups
        packed.counts[0] = count if shared >= WORTH_IT else 0

    return kernel(find_stages, spec)


def make_share_stages(spec: Spec, visit_groups: Any) -> Any:
    """Return `kernel(packed, member, word)`: what a member makes of a sweep.

    visit_groups: kernel(packed, first, last, own) -> greatest change.
    """

    def share_stages(packed, member, word):
        team, stages, size, own = (
            packed.team,
            packed.stages,
            size_of(word),
            2 * (1 + member) * STRIDE,
        )
        valid, (count, _, _) = arguments(team.words, word)
        if not valid:
            return
        pieces = EACH * size
        for s in range(count):
            if not await_pieces(team.words, s * pieces, word):
                return
            for turn in range(pieces):
                piece = (EACH * member + turn) % pieces
                if claim(team, s * pieces + piece, word):
                    first, last = stages[s] // 2, stages[s + 1] // 2
                    if stages[s] % 2 == 1:
                        begin, groups = first, last - first
                        first = begin + groups * piece // pieces
                        last = begin + groups * (piece + 1) // pieces
                    elif piece > 0:
                        last = first
                    finish(team, member, 0, visit_groups(packed, first, last, own))

    return kernel(share_stages, spec)


def make_share_runs(spec: Spec, visit_groups: Any) -> Any:
    """Return `kernel(packed, member, word)`: the same of sweeps that follow each other.

    A run is visited in a sweep when all that share a movable body with it were in that before.
    """

    def share_runs(packed, member, word):
        team, size, own = packed.team, size_of(word), 2 * (1 + member) * STRIDE
        valid, (groups, sweeps, behind) = arguments(team.words, word)
        if not valid:
            return
        runs, made = (groups + RUN - 1) // RUN, 0
        for leading in range(runs + (sweeps - 1) * behind):
            if not await_pieces(team.words, made, word):
                return
            for turn in range(2 * sweeps):  # first those that are meant for this member
                k = turn % sweeps
                run = leading - k * behind
                if 0 <= run < runs:
                    made += turn // sweeps
                    if (run % size == member) == (turn < sweeps):
                        if claim(team, leading * sweeps + k, word):
                            last = min((run + 1) * RUN, groups)
                            change = visit_groups(packed, run * RUN, last, own)
                            finish(team, member, k, change)

    return kernel(share_runs, spec)


def make_share_sweep(spec: Spec, visit_groups: Any, task: int) -> Any:
    """Return `kernel(packed, slots) -> greatest change`: a sweep, by the team where that pays.

    visit_groups: kernel(packed, first, last, own) -> greatest change; task: SWEEP or PUSH.
    """
    share_stages = make_share_stages(spec, visit_groups)

    def sweep(packed, slots):
        team, count, word = packed.team, packed.counts[0], 0
        if count == 0:
            return visit_groups(packed, 0, slots // WIDTH, STRIDE)
        begin = nanoseconds()
        if is_worth_it(team.trials, task):
            word = fork(team, MOST, task, (count, 0, 0))
        if word > 0:
            share_stages(packed, 0, word)
            await_pieces(team.words, EACH * size_of(word) * count, word)
            greatest = greatest_of(team, word, 0)
        else:
            greatest = visit_groups(packed, 0, slots // WIDTH, STRIDE)
        note_time(team.trials, task, word > 0, nanoseconds() - begin)
        return greatest

    return kernel(sweep, spec)


def make_share_following(spec: Spec, visit_groups: Any, alone: Any) -> Any:
    """Return `kernel(packed, slots, sweeps)`: these sweeps, by the team where that pays.

    Greatest changes go to `packed.changes`, the last sweep's first. alone: kernel(packed, slots,
    sweeps), the same by one thread.
    """
    share_runs = make_share_runs(spec, visit_groups)

    def follow(packed, slots, sweeps):
        team, groups, word = packed.team, slots // WIDTH, 0
        size = min(1 + load(team.words, MEMBERS), sweeps)
        if size < 2:
            alone(packed, slots, sweeps)
            return
        begin = nanoseconds()
        if is_worth_it(team.trials, FOLLOW):
            behind = _distance(packed.reach[0], size)
            word = fork(team, size, FOLLOW, (groups, sweeps, behind))
        if word > 0:
            share_runs(packed, 0, word)
            await_pieces(team.words, (groups + RUN - 1) // RUN * sweeps, word)
            for k in range(sweeps):
                packed.changes[sweeps - 1 - k] = greatest_of(team, word, k)
        else:
            alone(packed, slots, sweeps)
        note_time(team.trials, FOLLOW, word > 0, nanoseconds() - begin)

    return kernel(follow, spec)


def make_serve(spec: Spec) -> Any:
    """Return `kernel(packed)`: what a member does while a call of the step lasts."""
    from .apart import make_push_groups
    from .sweep import make_sweep_groups

    sweep_groups = make_sweep_groups(spec)
    share_stages = make_share_stages(spec, sweep_groups)
    share_runs = make_share_runs(spec, sweep_groups)
    share_pushes = make_share_stages(spec, make_push_groups(spec))

    def serve(packed):
        words = packed.team.words
        word = load(words, FORK)
        member = 1 + fetch_add(words, MEMBERS, 1)
        while word % SIZE != LEAVE:
            word = await_fork(words, word)
            task = word % SIZE
            if member < size_of(word):
                if task == SWEEP:
                    share_stages(packed, member, word)
                elif task == FOLLOW:
                    share_runs(packed, member, word)
                elif task == PUSH:
                    share_pushes(packed, member, word)

    return kernel(serve, spec)
