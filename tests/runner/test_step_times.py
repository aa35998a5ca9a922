"""Times of steps are whole nanoseconds of an exact ratio: they neither drift nor repeat."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from lavendersim.runner.cell import time_ns

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
    assert time_ns(steps, timestep).tolist() == exact
    assert time_ns(steps, timestep).dtype == np.int64


@pytest.mark.parametrize("timestep", [Fraction(1, 480), Fraction(1, 3)], ids=str)
def test_whole_seconds_are_whole(timestep: Fraction) -> None:
    seconds = np.arange(0, 10_000, 7)
    assert time_ns(seconds * timestep.denominator, timestep).tolist() == (seconds * 10**9).tolist()


def test_known_times_of_a_third_of_a_second() -> None:
    steps = np.arange(5)
    assert time_ns(steps, Fraction(1, 3)).tolist() == [
        0,
        333_333_333,
        666_666_666,
        1_000_000_000,
        1_333_333_333,
    ]
