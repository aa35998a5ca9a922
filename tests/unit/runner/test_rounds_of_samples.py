"""Rounds: as many as asked for, none that would change nothing, and what a signal leaves."""

from __future__ import annotations

from itertools import count

import pytest

from lavendersim.experiment.models.cost import FEWEST_REPEATS
from lavendersim.runner.rounds import SETTLED, Taken, take_rounds

WIDE, NARROW = 2 * SETTLED, 0.5 * SETTLED


def taken(
    rounds: int, widths: list[float], stop_in: int = -1
) -> tuple[Taken, list[int], list[tuple[int, int]]]:
    """Return what became of rounds, which were begun, and what was reported of them."""
    begun: list[int] = []
    reports: list[tuple[int, int]] = []

    def one(number: int) -> None:
        begun.append(number)
        if number == stop_in:
            raise KeyboardInterrupt("interrupted by SIGINT")

    def report(what: str, done: int, of: int) -> None:
        assert what == "rounds"
        reports.append((done, of))

    return take_rounds("rounds", rounds, one, lambda: widths, report), begun, reports


def test_rounds_end_where_all_intervals_are_narrow_and_not_before_they_hold_their_median() -> None:
    ended, begun, reports = taken(100, [NARROW, NARROW])
    assert ended == Taken(FEWEST_REPEATS)
    assert begun == list(range(FEWEST_REPEATS))
    assert reports[-1] == (FEWEST_REPEATS, FEWEST_REPEATS)


def test_one_wide_interval_takes_every_round() -> None:
    ended, begun, reports = taken(20, [NARROW, WIDE])
    assert ended == Taken(20)
    assert len(begun) == 20
    assert reports == [(done, 20) for done in range(21)]


def test_rounds_go_on_until_the_last_interval_is_narrow() -> None:
    calls = count()
    widths = lambda: [WIDE if next(calls) < 3 else NARROW]  # noqa: E731
    ended = take_rounds("rounds", 50, lambda number: None, widths, lambda *said: None)
    assert ended == Taken(FEWEST_REPEATS + 3)


def test_an_engine_without_samples_keeps_no_one_waiting() -> None:
    assert taken(20, [float("nan")])[0] == Taken(FEWEST_REPEATS)


def test_what_is_interrupted_has_its_whole_rounds() -> None:
    ended, begun, _ = taken(9, [WIDE], stop_in=4)
    assert ended == Taken(4, "interrupted by SIGINT after 4 of 9 rounds")
    assert begun == [0, 1, 2, 3, 4]


def test_the_first_round_leaves_nothing_to_keep() -> None:
    with pytest.raises(KeyboardInterrupt):
        taken(9, [WIDE], stop_in=0)
