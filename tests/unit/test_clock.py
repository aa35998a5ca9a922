"""Times of steps are exact, whatever the timestep was before, and whole nanoseconds in a log."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lavendersim.clock import Clock
from lavendersim.quantities.scalars import exact

TIMESTEPS = [
    Fraction(1, 480),
    Fraction(1, 3),
    Fraction(1, 240),
    Fraction(1, 1000),
    Fraction("0.0041666666666666666"),  # a denominator beyond 64-bit products
    Fraction(7, 3),
]


@pytest.mark.parametrize("timestep", TIMESTEPS, ids=str)
@pytest.mark.parametrize("first", [0, 10**6, 10**9])
def test_a_step_ends_at_its_exact_time_rounded_down(timestep: Fraction, first: int) -> None:
    steps = np.arange(first, first + 1000)
    exact = [int(int(step) * timestep * 10**9) for step in steps]
    assert Clock(timestep).nanoseconds(steps).tolist() == exact
    assert Clock(timestep).nanoseconds(steps).dtype == np.int64


@pytest.mark.parametrize("timestep", [Fraction(1, 480), Fraction(1, 3)], ids=str)
def test_whole_seconds_are_whole(timestep: Fraction) -> None:
    seconds = np.arange(0, 10_000, 7)
    times = Clock(timestep).nanoseconds(seconds * timestep.denominator)
    assert times.tolist() == (seconds * 10**9).tolist()


def test_known_times_of_a_third_of_a_second() -> None:
    steps = np.arange(5)
    assert Clock(Fraction(1, 3)).nanoseconds(steps).tolist() == [
        0,
        333_333_333,
        666_666_666,
        1_000_000_000,
        1_333_333_333,
    ]


# 1/10 s up to 0.2 s, 1/7 s up to the first time at 0.5 s or behind it, 0.2 + 3/7; then 1/3 s.
CHANGING = Clock(
    Fraction(1, 10),
    [(Fraction(1, 5), Fraction(1, 7)), (Fraction(1, 2), Fraction(1, 3))],
)


def test_a_change_waits_for_whole_steps_of_the_timestep_before() -> None:
    times = [0, "1/10", "1/5", "12/35", "17/35", "22/35", "101/105", "136/105"]
    assert [CHANGING.time(done) for done in range(8)] == [Fraction(time) for time in times]
    assert [CHANGING.length(step) for step in range(1, 7)] == [
        *[Fraction(1, 10)] * 2, *[Fraction(1, 7)] * 3, Fraction(1, 3)
    ]  # fmt: skip
    assert CHANGING.changes == [(2, Fraction(1, 7)), (5, Fraction(1, 3))]
    assert (CHANGING.timestep, CHANGING.longest) == (Fraction(1, 10), Fraction(1, 3))


def test_a_time_is_reached_by_the_first_step_that_ends_there_or_later() -> None:
    reached = {"0": 0, "1/20": 1, "1/5": 2, "0.21": 3, "12/35": 3, "0.5": 5, "0.9": 6, "1": 7}
    assert {time: CHANGING.steps_until(Fraction(time)) for time in reached} == reached
    within = {"0": 0, "0.19": 1, "1/5": 2, "0.5": 4, "22/35": 5, "0.9": 5, "1": 6}
    assert {time: CHANGING.steps_within(Fraction(time)) for time in within} == within


def test_a_run_of_one_timestep_has_the_nearest_number_of_steps() -> None:
    clock = Clock(Fraction(3, 10), [(Fraction(2), Fraction(1, 10))])
    assert [clock.steps_of(Fraction(time)) for time in ("1", "0.76", "1.7")] == [3, 3, 6]


def test_a_run_whose_timestep_changes_reaches_its_end() -> None:
    """Steps of 1/10 s to 0.2 s, of 1/7 s to 0.628.. s, of 1/3 s: the last ends at 0.9619 s."""
    assert CHANGING.steps_of(Fraction("0.95")) == 6
    assert CHANGING.steps_of(Fraction("0.9620")) == 7


def test_changes_at_one_time_leave_the_last_and_changes_to_the_same_leave_none() -> None:
    tenth, other = Fraction(1, 10), Fraction(1, 7)
    at = Fraction(1, 2)
    assert Clock(tenth, [(at, other), (at, Fraction(1, 9))]).changes == [(5, Fraction(1, 9))]
    assert Clock(tenth, [(at, other), (Fraction("0.45"), Fraction(1, 9))]).changes == [(5, other)]
    assert Clock(tenth, [(at, other), (at, tenth)]).changes == []
    assert Clock(tenth, [(at, tenth)]).changes == []
    assert Clock(tenth, [(Fraction(0), other)]).stretches == [(0, Fraction(0), other)]


LENGTHS = st.fractions(Fraction(1, 2000), Fraction(1, 5), max_denominator=10_000)


@settings(max_examples=60, deadline=None)
@given(
    first=LENGTHS,
    changes=st.lists(st.tuples(st.fractions(0, 2, max_denominator=1000), LENGTHS), max_size=5),
)
@example(  # the common denominator of its times is beyond 64 bits
    first=Fraction(1, 2000),
    changes=[
        (Fraction(0), Fraction(7, 5963)),
        (Fraction(1, 15), Fraction(11, 4000)),
        (Fraction(1, 3), Fraction(11, 9723)),
        (Fraction(1), Fraction(78, 8329)),
        (Fraction(2), Fraction(3, 5077)),
    ],
)
def test_one_step_after_the_other_gives_the_same_times(
    first: Fraction, changes: list[tuple[Fraction, Fraction]]
) -> None:
    clock = Clock(first, changes)
    steps = np.arange(300)
    times, lengths = [Fraction(0)], []
    for done in range(300):
        due = [length for at, length in sorted(changes, key=lambda one: one[0]) if at <= times[-1]]
        lengths.append(due[-1] if due else first)
        times.append(times[-1] + lengths[-1])
        assert clock.time(done) == times[done]
        assert clock.steps_until(times[done]) == clock.steps_within(times[done]) == done
    assert [clock.length(step + 1) for step in range(300)] == lengths
    assert clock.lengths(steps + 1).tolist() == [float(length) for length in lengths]
    assert clock.nanoseconds(steps).tolist() == [int(time * 10**9) for time in times[:300]]
    # each of at most six stretches is rounded twice
    exact = np.array([float(times[step] - times[0]) for step in steps])
    assert np.abs(clock.elapsed(0, steps) - exact).max() <= 12 * 2.0**-53 * exact[-1]
    assert clock.elapsed(steps[:-1], steps[1:]).tolist() == clock.lengths(steps[1:]).tolist()
    rebuilt = Clock.counted(clock.timestep, clock.changes)
    assert rebuilt.stretches == clock.stretches


def test_a_time_written_as_a_ratio_is_the_step_that_begins_there() -> None:
    """5/6 s are 200 steps of 1/240 s, also where the ratio has become a float on the way."""
    assert Clock(Fraction(1, 240)).steps_until(exact(5 / 6)) == 200
