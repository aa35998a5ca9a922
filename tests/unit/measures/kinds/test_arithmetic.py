"""Measures of measures, number by number; NaN where there is nothing to divide by."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.errors import LavenderError
from lavendersim.measures.kinds.arithmetic import derived
from lavendersim.measures.specs.arithmetic import DifferenceOf, OfRow, Power, Ratio

NAN = float("nan")
RATIO = Ratio(kind="ratio", measure="a", to="b")
LESS = DifferenceOf(kind="difference", measure="a", minus="b")


def of(statistic: str) -> OfRow:
    return OfRow.model_validate({"kind": "of_row", "measure": "a", "of": statistic})


def test_rows_are_divided_and_subtracted_number_by_number() -> None:
    rows = [np.array([6.0, 8.0, 1.0]), np.array([2.0, -4.0, 0.0])]
    np.testing.assert_array_equal(derived(RATIO, rows), [3.0, -2.0, NAN])
    np.testing.assert_array_equal(derived(LESS, rows), [4.0, 12.0, 1.0])


@pytest.mark.parametrize(("spec", "expected"), [(RATIO, [2.0, 3.0]), (LESS, [2.0, 4.0])])
def test_one_number_stands_beside_every_number_of_a_row(
    spec: object, expected: list[float]
) -> None:
    assert derived(spec, [np.array([4.0, 6.0]), np.array([2.0])]).tolist() == expected


def test_rows_of_other_lengths_are_refused_by_name() -> None:
    with pytest.raises(LavenderError, match="a has 2 and b has 3 numbers"):
        derived(RATIO, [np.ones(2), np.ones(3)])


def test_a_power_is_one_of_each_number_and_none_where_there_is_none() -> None:
    def to(exponent: float) -> list[float]:
        spec = Power(kind="power", measure="a", exponent=exponent)
        return derived(spec, [np.array([4.0, 0.0, -2.0])]).tolist()

    np.testing.assert_array_equal(to(0.5), [2.0, 0.0, NAN])
    np.testing.assert_array_equal(to(2.0), [16.0, 0.0, 4.0])
    np.testing.assert_array_equal(to(-1.0), [0.25, NAN, -0.5])


@pytest.mark.parametrize(
    ("statistic", "expected"),
    [("max", 5.0), ("min", -3.0), ("mean", 1.0), ("sum", 4.0), ("first", 5.0), ("last", -3.0)],
)
def test_one_number_of_a_row(statistic: str, expected: float) -> None:
    row = np.array([5.0, 2.0, 0.0, -3.0])
    assert derived(of(statistic), [row]).tolist() == [expected]
    assert np.isnan(derived(of(statistic), [np.array([5.0, NAN])])).tolist() == [True]
    assert np.isnan(derived(of(statistic), [np.array([])])).tolist() == [True]
