"""Series of a panel: cells by an axis, means and ranges at a place, and how many are drawn."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.figures.series import (
    axis_of,
    band_along,
    band_of_rows,
    by_value,
    looks_of,
    series_of,
    swept_path,
    within,
)
from lavendersim.figures.style import LOOKS


def cell(**coordinates: Any) -> Any:
    """Return a cell at these coordinates."""
    return SimpleNamespace(coordinates=coordinates)


CELLS = [cell(e=e, solver=solver) for solver in ("one_more", "other") for e in (0.5, 0.0)]


def test_a_series_for_each_value_in_the_order_of_the_sweep() -> None:
    found = series_of(CELLS, "solver")
    assert [one.label for one in found] == ["solver = one more", "solver = other"]
    assert [one.cells for one in found] == [CELLS[:2], CELLS[2:]]
    assert [one.number for one in found] == [None, None]
    assert [one.number for one in series_of(CELLS, "e")] == [0.5, 0.0]


def test_a_label_of_ones_own_and_cells_without_the_axis() -> None:
    (one,) = series_of([*CELLS[:1], cell(x=1)], "e", "restitution {}")
    assert (one.label, one.cells) == ("restitution 0.5", CELLS[:1])
    (whole,) = series_of(CELLS, None)
    assert whole.cells == CELLS
    assert series_of([], None) == []


def test_cells_differ_by_one_axis_or_by_none_that_could_be_named() -> None:
    swept = [cell(e=0.5, mass=1), cell(e=0.9, mass=1)]
    assert axis_of(swept) == "e"
    assert axis_of(swept[:1]) is None
    assert axis_of([*swept, cell(e=0.5, mass=2)]) is None
    assert axis_of([*swept, cell(mass=1)]) is None  # of another product
    assert axis_of([]) is None


def test_a_damaged_log_is_marked() -> None:
    damaged = SimpleNamespace(
        coordinates={"e": 0.5}, allow_incomplete=True, damage=lambda: "cut off"
    )
    assert series_of([damaged], "e")[0].label == "e = 0.5 (incomplete)"


def test_mean_and_range_at_each_place_in_rising_order() -> None:
    numbers = dict(zip(map(id, CELLS), (1.0, 5.0, 3.0, 7.0), strict=True))
    band = band_along(CELLS, "e", lambda one: numbers[id(one)], factor=10.0)
    assert band.places.tolist() == [0.0, 0.5]
    assert band.mean.tolist() == [60.0, 20.0]
    assert (band.low.tolist(), band.high.tolist()) == ([50.0, 10.0], [70.0, 30.0])
    assert band.spread
    assert not band_along(CELLS[:2], "e", lambda one: 1.0).spread


def test_rows_against_their_index_end_with_the_shortest() -> None:
    band = band_of_rows([np.array([1.0, 2.0, 9.0]), np.array([3.0, 4.0])], 1)
    assert band.places.tolist() == [1.0, 2.0]
    assert band.mean.tolist() == [2.0, 3.0]


def test_values_are_those_that_are_written() -> None:
    cells = [cell(dt=Fraction(1, 480)), cell(dt=Fraction(1, 240))]
    assert list(by_value(cells, "dt")) == ["1/480", "1/240"]


def test_few_series_have_a_mark_each_and_many_numbers_a_scale_by_rank() -> None:
    few = series_of([cell(e=0.1 * k) for k in range(5)], "e")
    assert looks_of(few) == list(LOOKS[:5])
    many = series_of([cell(e=e) for e in (0.5, 0.1, 0.9, 0.3, 0.7, 0.2)], "e")
    looks = looks_of(many)
    assert len({look.colour for look in looks}) == 6
    assert all(look.joined and not look.marker for look in looks)
    # Named are the lowest, the middle (third of six) and the highest.
    assert [one.number for one, look in zip(many, looks, strict=True) if look.named] == [
        *(0.1, 0.9, 0.3),
    ]
    names = series_of([cell(e=f"name_{k}") for k in range(6)], "e")
    assert all(look.marker for look in looks_of(names))


@pytest.mark.parametrize("sweep", [["e"], ["x", "e"]], ids=["one product", "several"])
def test_the_path_that_an_axis_varies(sweep: list[str]) -> None:
    axis = SimpleNamespace(every_path=["scene.e", "scene.f"])
    products = [dict.fromkeys(one, axis) for one in sweep]
    made = products[0] if len(products) == 1 else products
    experiment = SimpleNamespace(config=SimpleNamespace(sweep=made))
    assert swept_path(experiment, "e") == "scene.e"
    assert swept_path(experiment, "z") is None


def test_a_window_has_both_its_ends() -> None:
    time = np.array([0.0, 0.5, 1.0, 1.5])
    assert within((0.5, 1.0), time).tolist() == [False, True, True, False]
    assert within(None, time).all()
