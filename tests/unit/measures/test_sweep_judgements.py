"""Judgements across cells: trends, ratios, orders and crossings, each passing and failing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from judged import NAN, cell, expect, passed

from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.measures.sweep_judgements import along_axis, first_rise, reduced


@pytest.mark.parametrize(
    ("numbers", "good"),
    [
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 5.0, (1, 1): 6.0}, True),
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 6.0, (1, 1): 6.0}, False),  # equal is not a rise
        ({(0, 0): 1.0, (1, 0): NAN, (0, 1): 5.0, (1, 1): 6.0}, False),
        ({(0, 0): 1.0, (1, 0): 2.0, (0, 1): 5.0}, False),  # a group with one value only
    ],
)
def test_increasing_along_an_axis_in_every_group(numbers: Any, good: bool) -> None:
    cells = [cell(number, a=a, b=b) for (a, b), number in numbers.items()]
    assert passed(expect(increasing={"along": "a"}), *cells) is good
    assert not passed(expect(decreasing={"along": "a"}), *cells)


def test_decreasing_ignores_the_order_of_the_sweep() -> None:
    cells = [cell(1.0, a=3), cell(3.0, a=1), cell(2.0, a=2)]
    assert passed(expect(decreasing={"along": "a"}), *cells)


@pytest.mark.parametrize(
    ("fine", "coarse", "good"),
    [
        (1.0, 2.0, True),
        (2.0, 1.0, False),
        (1e-10, 1e-12, True),  # it grew, but both are nothing
        (0.0, 0.0, True),
        (1.1e-9, 1e-12, False),
        (NAN, 1.0, False),
    ],
)
def test_a_negligible_numerator_needs_no_ratio(fine: float, coarse: float, good: bool) -> None:
    ratio = {"of": {"a": 0}, "to": {"a": 1}, "at_most": 1.0, "negligible": 1e-9}
    assert passed(expect(ratio=ratio), cell(fine, a=0), cell(coarse, a=1)) is good


@pytest.mark.parametrize(
    ("numbers", "good"),
    [
        ({1.0: 3.0, 2.0: 12.0, 4.0: 48.0}, True),  # exactly 2
        ({1.0: 3.0, 2.0: 11.0, 4.0: 41.0}, False),  # log2(41/3)/2 = 1.886
        ({1.0: 3.0, 2.0: 15.0, 4.0: 60.0}, False),  # log2(60/3)/2 = 2.16
        ({1.0: 1e-12, 2.0: 0.0, 4.0: 5e-13}, True),  # round-off has no order
        ({1.0: 3.0, 2.0: NAN, 4.0: 48.0}, False),
        ({1.0: 3.0, 2.0: 0.0, 4.0: 48.0}, False),
        ({1.0: 3.0}, False),
    ],
)
def test_the_order_is_the_slope_between_logarithms(numbers: Any, good: bool) -> None:
    order = {"along": "dt", "at_least": 1.9, "at_most": 2.1, "negligible": 1e-9}
    cells = [cell(0.5 * number, dt=dt, b=b) for dt, number in numbers.items() for b in (0, 1)]
    cells += [cell(number, dt=dt, b=2) for dt, number in numbers.items()]
    assert passed(expect(order=order), *cells) is good


def test_a_ratio_reduces_the_other_axes_first() -> None:
    cells = [cell(1.0, a=0, b=0), cell(2.0, a=0, b=1), cell(8.0, a=1, b=0), cell(4.0, a=1, b=1)]

    def ratio(reduce: str, **bounds: float) -> ExpectSpec:
        return expect(ratio={"of": {"a": 1}, "to": {"a": 0}, "reduce": reduce, **bounds})

    assert passed(ratio("max", at_most=4.0, at_least=4.0), *cells)  # 8 / 2
    assert passed(ratio("min", at_most=4.0, at_least=4.0), *cells)  # 4 / 1
    assert passed(ratio("mean", at_most=4.0, at_least=4.0), *cells)  # 6 / 1.5
    assert not passed(ratio("max", at_most=3.9), *cells)
    assert not passed(ratio("max", at_least=4.1), *cells)


def test_a_ratio_for_each_value_of_an_axis() -> None:
    cells = [cell(1.0, a=0, b=0), cell(1.0, a=0, b=1), cell(8.0, a=1, b=0), cell(2.0, a=1, b=1)]
    spec = {"of": {"a": 1}, "to": {"a": 0}, "reduce": "max"}
    assert passed(expect(ratio={**spec, "at_least": 5.0}), *cells)
    assert not passed(expect(ratio={**spec, "each": ("b",), "at_least": 5.0}), *cells)


def test_rows_are_compared_number_by_number_down_to_the_floor() -> None:
    cells = [cell([20.0, 2.0, 1e-16], a=0), cell([1.0, 0.1, 1e-16], a=1)]
    spec = {"of": {"a": 0}, "to": {"a": 1}, "at_least": 15.0}
    assert passed(expect("row", ratio={**spec, "floor": 1e-13}), *cells)
    assert not passed(expect("row", ratio=spec), *cells)  # the last number is round-off


@pytest.mark.parametrize(
    ("top", "bottom"), [(NAN, 1.0), (1.0, NAN), (0.0, 0.0)], ids=["nan", "to nan", "zero"]
)
def test_a_ratio_of_nothing_fails(top: float, bottom: float) -> None:
    spec = {"of": {"a": 0}, "to": {"a": 1}, "at_least": -1.0}
    assert not passed(expect(ratio=spec), cell(top, a=0), cell(bottom, a=1))


def test_a_ratio_with_nothing_on_one_side_fails() -> None:
    spec = {"of": {"a": 0}, "to": {"a": 7}, "at_least": 0.0}
    assert not passed(expect(ratio=spec), cell(1.0, a=0), cell(1.0, a=1))


@pytest.mark.parametrize(
    ("numbers", "good"),
    [([0.0, 0.5, 1.5], True), ([0.0, 0.1, 0.2], False), ([2.0, 3.0, 4.0], False)],
)
def test_crossing_a_level_is_interpolated(numbers: list[float], good: bool) -> None:
    cells = [cell(number, a=a) for a, number in enumerate(numbers)]  # rises through 1 at a = 1.5
    spec = {"along": "a", "level": 1.0, "between": (1.49, 1.51)}
    assert passed(expect(crosses=spec), *cells) is good


def test_a_polyline_is_crossed_where_its_line_is() -> None:
    assert first_rise([0.0, 1.0, 3.0], [0.0, 0.5, 1.5], 1.0) == 2.0
    assert first_rise([0.0, 1.0, 2.0], [0.0, 1.0, 0.0], 1.0) == 1.0  # reached is crossed
    assert np.isnan(first_rise([0.0, 1.0], [1.0, 2.0], 1.0))  # it begins there
    assert np.isnan(first_rise([0.0, 1.0], [2.0, 0.0], 1.0))  # it falls


def test_stations_of_an_axis_are_sorted_and_reduced() -> None:
    cells = [cell(5.0, a=2, b=0), cell(1.0, a=1, b=0), cell(7.0, a=2, b=1), cell(9.0, b=1)]
    numbers = {id(one): np.array([float(k)]) for k, one in enumerate(cells)}
    places, means = along_axis(cells, lambda one: numbers[id(one)], "a", "mean")
    assert (places, means) == ([1.0, 2.0], [1.0, 1.0])  # the mean of 0 and 2
    assert along_axis(cells, lambda one: numbers[id(one)], "a", "max")[1] == [1.0, 2.0]


def test_rows_of_different_lengths_have_no_common_row() -> None:
    rows = iter([np.array([1.0, 5.0]), np.array([3.0])])
    assert np.isnan(reduced([cell(1.0), cell(1.0)], lambda one: next(rows), "max")).all()
    rows = iter([np.array([1.0, 5.0]), np.array([3.0, 2.0])])
    assert reduced([cell(1.0), cell(1.0)], lambda one: next(rows), "max").tolist() == [3.0, 5.0]
