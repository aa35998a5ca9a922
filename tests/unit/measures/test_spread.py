"""Median, quartiles and the interval that holds the true median."""

from __future__ import annotations

from lavendersim.measures.spread import Spread, samples_beyond


def test_intervals_hold_the_median_in_nineteen_of_twenty_cases() -> None:
    # P(at most k of n fair coins show heads) <= 1/40: by the table of the binomial distribution,
    # n = 9: 10/512 for k = 1, 46/512 for k = 2; n = 6: 1/64 for k = 0, 7/64 for k = 1; n = 25:
    # k = 7 gives 0.0216, k = 8 0.0539.
    assert [samples_beyond(n) for n in (1, 3, 6, 9, 25)] == [0, 0, 0, 1, 7]


def test_the_spread_of_samples_is_that_of_the_ordered_ones() -> None:
    # of nine the interval leaves one out at either end
    found = Spread.of([9.0, 1.0, 8.0, 2.0, 7.0, 3.0, 6.0, 4.0, 5.0])
    assert found == Spread(median=5.0, lower_quartile=3.0, upper_quartile=7.0, low=2.0, high=8.0)
    assert found.per(2.0).high == 4.0
