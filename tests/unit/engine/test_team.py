"""A team makes every piece of a task once, waits for nobody who has claimed none, and ends."""

from __future__ import annotations

import threading
from functools import partial

import numpy as np
import pytest

from lavendersim.engine import team
from lavendersim.engine.atomics import CAN_WAIT, fetch_add, load
from lavendersim.engine.compile import inner

pytestmark = pytest.mark.skipif(not CAN_WAIT, reason="threads wait by what POSIX has")
PIECES, FORKS, THREADS = 24, 300, 4


@inner
def make_pieces(memory, made, member, word):
    """Count every piece that this member claims; each is numbered by the fork before it, too."""
    valid, (count, _, _) = team.arguments(memory.words, word)
    if not valid:
        return
    for k in range(count):
        piece = (member + k) % count
        if team.claim(memory, piece, word):
            made[piece] += 1  # no atom: nobody else may write it now
            team.finish(memory, member, 0, float(piece))


@inner
def serve(memory, made):
    """Do what members do while a step lasts."""
    word = load(memory.words, team.FORK)
    member = 1 + fetch_add(memory.words, team.MEMBERS, 1)
    while word % team.SIZE != team.LEAVE:
        word = team.await_fork(memory.words, word)
        if member < team.size_of(word):
            make_pieces(memory, made, member, word)


@inner
def step(memory, made, most, members):
    """Fork and join often; return the forks at which anything was left, or found twice."""
    wrong = 0
    while load(memory.words, team.MEMBERS) < members:
        pass
    for k in range(FORKS):
        count = 1 + k % PIECES
        word = team.fork(memory, most, team.SWEEP, (count, 0, 0))
        if word == 0:
            return -1
        make_pieces(memory, made, 0, word)
        team.await_pieces(memory.words, count, word)
        if team.greatest_of(memory, word, 0) != count - 1.0:
            wrong += 1
    return wrong


def memory_and_counts() -> tuple[team.TeamMemory, np.ndarray]:
    memory, made = team.allocate_team(PIECES), np.zeros(PIECES, np.int64)
    serve(memory, made)  # compiled here: it leaves at once
    memory.words[:] = 0
    return memory, made


@pytest.mark.parametrize("most", [2, 3, team.MOST])
def test_every_piece_is_made_once_in_every_fork(most: int) -> None:
    memory, made = memory_and_counts()
    step(memory, made, most, 0)  # no member: it is compiled, and says so
    assert not made.any()
    run = partial(step, memory, made, most, THREADS - 1)
    assert team.with_team(partial(serve, memory, made), memory.words, THREADS, run) == 0
    expected = [sum(1 + k % PIECES > piece for k in range(FORKS)) for piece in range(PIECES)]
    assert made.tolist() == expected


def test_a_team_of_one_has_nothing_to_fork_for() -> None:
    memory, made = memory_and_counts()
    run = partial(step, memory, made, team.MOST, 0)
    assert team.with_team(partial(serve, memory, made), memory.words, 1, run) == -1


def test_who_comes_too_late_makes_nothing() -> None:
    """With the word of a fork that is over, whatever the next one has been given."""
    memory, made = memory_and_counts()
    memory.words[team.MEMBERS] = 1

    def forked(count: int) -> int:
        return int(team.fork(memory, 2, team.SWEEP, (count, 0, 0)))

    old = forked(3)
    make_pieces(memory, made, 0, old)
    make_pieces(memory, made, 1, old)  # all are claimed
    assert made[:4].tolist() == [1, 1, 1, 0]
    new = forked(PIECES)
    make_pieces(memory, made, 1, old)  # another fork
    assert made.sum() == 3
    assert not team.claim(memory, 2, old)
    assert not team.await_pieces(memory.words, PIECES, old)
    assert new > old
    assert team.size_of(new) == 2


@pytest.mark.parametrize("fails", [False, True])
def test_no_thread_outlives_a_call(fails: bool) -> None:
    memory, made = memory_and_counts()
    before = threading.active_count()

    def call() -> int:
        assert threading.active_count() == before + THREADS - 1 or made.sum() == 0
        if fails:
            raise KeyboardInterrupt
        return 7

    run = partial(team.with_team, partial(serve, memory, made), memory.words, THREADS, call)
    if fails:
        with pytest.raises(KeyboardInterrupt):
            run()
    else:
        assert run() == 7
    assert threading.active_count() == before
    assert memory.words[team.MEMBERS] == 0


def test_a_task_is_shared_where_that_took_less() -> None:
    """Of every 64 times two are made alone, two are shared, and 60 as what took least says."""
    for alone, shared in ((10, 7), (7, 10)):
        trials, found = np.zeros_like(team.allocate_team(0).trials), []
        for _ in range(3 * team.ROUND):
            found.append(bool(team.is_worth_it(trials, team.PUSH)))
            team.note_time(trials, team.PUSH, found[-1], shared if found[-1] else alone)
        of_round = [False] * 2 + [True] * 2 + [shared < alone] * (team.ROUND - 4)
        assert found == 3 * of_round
        assert not trials[: team.TRIAL * team.PUSH].any()  # of other tasks


def test_what_took_long_once_is_tried_again() -> None:
    trials = team.allocate_team(0).trials
    for _ in range(team.ROUND):
        shared = team.is_worth_it(trials, team.SWEEP)
        team.note_time(trials, team.SWEEP, shared, 1000 if shared else 10)
    for turn in range(2 * team.TWICE):
        shared = team.is_worth_it(trials, team.SWEEP)
        assert shared == (turn >= team.TWICE)
        team.note_time(trials, team.SWEEP, shared, 5 if shared else 10)
    assert team.is_worth_it(trials, team.SWEEP)
