"""Which cells of a sweep a selection means, and what tells cells apart."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.measures.selection import (
    coordinates_text,
    distinguishing_axes,
    group_by,
    same,
    select,
    selects,
)
from lavendersim.measures.specs.selection import ANY


def cell(**coordinates: Any) -> Any:
    """Return a cell at these coordinates."""
    return SimpleNamespace(coordinates=coordinates)


CELLS = [cell(e=e, solver=solver) for e in (0.0, 0.5) for solver in ("one", "other")]


@pytest.mark.parametrize(
    ("one", "other", "equal"),
    [
        (Fraction(1, 4), 0.25, True),
        (1, True, False),
        (True, True, True),
        ((1, 2), [1.0, Fraction(2)], True),
        ((1, 2), (1, 2, 3), False),
        ("a", "a", True),
        ("1", 1, False),
    ],
)
def test_values_are_the_same_by_number_but_not_by_kind(one: Any, other: Any, equal: bool) -> None:
    assert same(one, other) is equal
    assert same(other, one) is equal


def test_a_selection_means_a_value_one_of_several_or_any() -> None:
    assert selects({"e": 0.5}, {"e": Fraction(1, 2), "solver": "one"})
    assert selects({"e": [0.1, 0.5]}, {"e": 0.5})
    assert selects({"e": ANY}, {"e": 0.7})
    assert not selects({"e": 0.1}, {"e": 0.5})
    assert selects({}, {"e": 0.5})


def test_a_cell_without_the_axis_is_not_meant() -> None:
    assert not selects({"e": ANY}, {"solver": "one"})


def test_a_swept_list_is_one_value() -> None:
    assert selects({"place": (0.0, 1.0)}, {"place": (0.0, 1.0)})
    assert not selects({"place": (0.0, 1.0)}, {"place": (0.0, 2.0)})


def test_cells_that_every_selection_means_in_their_order() -> None:
    assert select(CELLS, {"solver": "other"}) == [CELLS[1], CELLS[3]]
    assert select(CELLS, {"solver": "other"}, {"e": 0.5}) == [CELLS[3]]
    assert select(CELLS) == CELLS


def test_groups_by_some_axes_or_by_all_but_one() -> None:
    assert group_by(CELLS, ["e"]) == {"e=0": CELLS[:2], "e=0.5": CELLS[2:]}
    by_solver = {"solver=one": [CELLS[0], CELLS[2]], "solver=other": [CELLS[1], CELLS[3]]}
    assert group_by(CELLS, without="e") == by_solver


def test_coordinates_are_written_as_in_the_file() -> None:
    at = {"timestep": Fraction(1, 480), "e": 0.5}
    assert coordinates_text(at, ["e", "timestep"]) == "e=0.5, timestep=1/480"


def test_axes_that_vary_or_were_named_tell_cells_apart() -> None:
    assert distinguishing_axes(CELLS, {}) == {"e", "solver"}
    assert distinguishing_axes(CELLS[:2], {}) == {"solver"}
    assert distinguishing_axes(CELLS[:2], {"e": 0.0, "absent": 1}) == {"e", "solver"}
