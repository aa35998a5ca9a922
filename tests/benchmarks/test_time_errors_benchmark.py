"""The benchmark of errors in time: what counts as missed, and that rows run."""

from __future__ import annotations

import math

import pytest

from tests.benchmarks.time_errors import balls
from tests.benchmarks.time_errors.__main__ import ROWS, measure
from tests.benchmarks.time_errors.row import Found, Row, table

SMOOTH = Row("it", "", lambda rate: {}, (math.inf, math.inf, 0.01), smooth=True)


def found(coarse: float, fine: float) -> Found:
    return Found(SMOOTH, {1000: {"one": coarse}, 4000: {"one": fine}})


def test_second_order_is_met_by_what_falls_by_the_square() -> None:
    one = found(9e-3, 9e-3 / 16)
    assert one.order == pytest.approx(2.0)
    assert not one.missed


def test_first_order_and_a_bar_that_is_missed_are_named() -> None:
    order, bar = found(0.01, 0.0025), found(0.0576, 0.0036)
    assert [line.split(":")[1] for line in order.missed] == [" order 1.00, at least 1.8"]
    assert bar.missed == ["it, one, 1/1000: 0.0576, at most 0.01"]


def test_what_is_no_number_is_missed() -> None:
    assert found(0.1, math.nan).missed


def test_every_row_has_another_name_and_scenes_at_each_rate() -> None:
    assert len({row.name for row in ROWS}) == len(ROWS)
    assert all(row.scenes(240) for row in ROWS)


def test_cradles_are_measured_against_their_twins() -> None:
    (row,) = (row for row in balls.ROWS if row.name.startswith("cradles"))
    (one,) = measure([row], (240,))
    assert len(one.errors[240]) == 12
    assert not one.missed
    assert table([one]).count("\n") == 2
