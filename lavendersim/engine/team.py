"""A team of threads that share the sweeps of a step: forked and joined within its kernel.

The thread that makes the step is member 0. The others wait in a kernel of their own while a call of
the step lasts. What is shared is cut into pieces, and a member claims a piece to make it: first
those that are meant for it, whose data its caches have, then any that are left. Nobody waits for a
member that claims nothing, so a thread that the system does not run costs no time.

Pieces that are made side by side share no movable body. Who makes which changes no bit. So the
clock may say whether a task is shared: it is made alone and shared in turns, twice of every ROUND,
and otherwise as it took less. What two caches tell each other may take longer than the task.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread
from typing import Any, NamedTuple

import numpy as np

from .atomics import fetch_add, load, raise_to, store, wait
from .compile import inner

# Members of a team at most, and numbers of two lines of the processor's cache: it asks for both.
MOST, LINE = 32, 16
# Words, each in lines of its own: the fork, pieces that are made, members, what the task needs.
FORK, MADE, MEMBERS, FIRST, SECOND, THIRD = range(0, 6 * LINE, LINE)
WORDS = THIRD + LINE
# What the fork says: OFTEN times how often there was one, SIZE times the members, and the task.
OFTEN, SIZE = 1 << 16, 1 << 8
LEAVE, IDLE, SWEEP, FOLLOW, PUSH = range(5)
# Of every task: how often it was made, and the least time alone and shared, in this round [ns].
OFTEN_MADE, ALONE, SHARED, TRIAL = range(4)
ROUND, TWICE = 64, 2
NEVER = 2**62


class TeamMemory(NamedTuple):
    """What the members of a team tell each other."""

    words: np.ndarray  # (WORDS,) int64
    claims: np.ndarray  # (pieces,) int64, the fork in which each was claimed last
    greatest: np.ndarray  # (MOST * LINE,) changes of each member's pieces, sweep by sweep
    trials: np.ndarray  # (TRIAL * (PUSH + 1),) int64, of each task; nobody else reads it


def allocate_team(pieces: int) -> TeamMemory:
    """Return the memory of a team of one, for tasks of so many pieces."""
    greatest = _alone(MOST * LINE).view(np.float64)
    claims, trials = np.zeros(pieces, np.int64), np.zeros(TRIAL * (PUSH + 1), np.int64)
    return TeamMemory(_alone(WORDS), claims, greatest, trials)


def _alone(count: int) -> np.ndarray:
    """Return zeros in lines of the cache that nothing else lies in: who waits there looks often."""
    padded = np.zeros(count + 2 * LINE, np.int64)
    begin = -padded.ctypes.data // padded.itemsize % LINE
    return padded[begin : begin + count]


@inner
def fork(team, most, task, given):
    """Let up to `most` members take part in a task; return the word of the fork, 0: there is none.

    given: three numbers that say which pieces there are. Who reads them (`arguments`) has those of
    the fork that it finds afterwards, and pieces of an earlier one are all claimed: who comes late
    can make none. Anything else is read by those who have claimed a piece.
    """
    words = team.words
    size = min(1 + load(words, MEMBERS), most)
    if size < 2:
        return 0
    often = load(words, FORK) // OFTEN + 1
    store(words, FORK, often * OFTEN + IDLE)
    store(words, FIRST, given[0])
    store(words, SECOND, given[1])
    store(words, THIRD, given[2])
    store(words, MADE, 0)
    for k in range(size * LINE):
        team.greatest[k] = 0.0
    word = (often + 1) * OFTEN + size * SIZE + task
    store(words, FORK, word)
    return word


@inner
def is_worth_it(trials, task):
    """Return whether a task is to be shared, by what it took before."""
    at = TRIAL * task
    turn = trials[at + OFTEN_MADE] % ROUND
    if turn < TWICE:
        return False
    if turn < 2 * TWICE:
        return True
    return trials[at + SHARED] < trials[at + ALONE]


@inner
def note_time(trials, task, shared, spent):
    """Note how long a task took [ns], shared or alone."""
    at = TRIAL * task
    turn = trials[at + OFTEN_MADE] % ROUND
    if turn == 0:
        trials[at + ALONE], trials[at + SHARED] = NEVER, NEVER
    if turn < 2 * TWICE:
        kind = at + (SHARED if shared else ALONE)
        trials[kind] = min(trials[kind], spent)
    trials[at + OFTEN_MADE] += 1


@inner
def arguments(words, word):
    """Return whether this is the fork still, and what its task needs."""
    given = load(words, FIRST), load(words, SECOND), load(words, THIRD)
    return load(words, FORK) == word, given


@inner
def size_of(word):
    """Return how many members take part in a fork."""
    return word // SIZE % SIZE


@inner
def claim(team, piece, word):
    """Return whether a piece of the fork is this member's to make; none is made twice."""
    return raise_to(team.claims, piece, word // OFTEN)


@inner
def finish(team, member, sweep, change):
    """Say that a piece that was claimed is made, and the greatest change in it."""
    at = member * LINE + sweep
    team.greatest[at] = max(change, team.greatest[at])
    fetch_add(team.words, MADE, 1)


@inner
def await_pieces(words, pieces, word):
    """Return whether so many pieces of the fork are made; waits, and is over with the fork."""
    spins = 0
    while True:
        made = load(words, MADE)
        if load(words, FORK) != word:
            return False
        if made >= pieces:
            return True
        spins = wait(spins)


@inner
def await_fork(words, word):
    """Return the word of the fork when it is another."""
    spins = 0
    found = load(words, FORK)
    while found == word:
        spins = wait(spins)
        found = load(words, FORK)
    return found


@inner
def greatest_of(team, word, sweep):
    """Return the greatest change in any piece of a sweep, when all are made."""
    most = 0.0
    for member in range(size_of(word)):
        most = max(team.greatest[member * LINE + sweep], most)
    return most


def with_team(
    serve: Callable[[], Any], words: np.ndarray, threads: int, step: Callable[[], int]
) -> int:
    """Return what the call of a step returns, while so many threads less one serve it.

    serve: called by each of them; returns when the words say LEAVE.
    """
    words[FORK], words[MEMBERS] = (words[FORK] // OFTEN + 1) * OFTEN + IDLE, 0
    others = [Thread(target=serve, daemon=True) for _ in range(min(threads, MOST) - 1)]
    try:
        for other in others:
            try:
                other.start()
            except RuntimeError:  # the system gives no more: fewer share
                break
        return step()
    finally:
        words[FORK] = (words[FORK] // OFTEN + 1) * OFTEN + LEAVE
        for other in others:
            if other.ident is not None:
                other.join()
        words[MEMBERS] = 0
