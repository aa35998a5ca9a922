"""Points of contacts for viewers: their form, and the grid of their positions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.trace.points import ROUGHLY, SHARE, grid_of, point_form


def row(*names: str) -> np.dtype:
    """Return a row of numbers."""
    return np.dtype([(name, "f8") for name in names])


def test_a_point_has_its_place_first_then_what_there_is_then_its_colour() -> None:
    form = point_form(row("impulse_n", "z", "y", "x", "force_n", "nx"))
    assert form.names == ("x", "y", "z", "nx", "force_n")
    assert form.size == 4 * 5 + 4
    names = [field.name for field in form.fields]
    assert names[:5] == list(form.names)
    assert [field.offset for field in form.fields[:6]] == [0, 4, 8, 12, 16, 20]
    assert set(form.names[3:]) < set(ROUGHLY)


def test_contacts_without_a_place_have_no_points() -> None:
    with pytest.raises(TypeError, match=r"columns \['z'\]"):
        point_form(row("x", "y"))


@pytest.mark.parametrize("thin", [1.0, 0.1, 3e-6, 7e4])
def test_the_grid_is_the_largest_power_of_two_within_its_share(thin: float) -> None:
    grid = grid_of([2.0 * thin, thin])
    assert math.frexp(grid)[0] == 0.5  # a power of two
    assert grid <= thin * SHARE < 2.0 * grid


def test_planes_have_no_thickness_and_alone_no_grid() -> None:
    assert grid_of([]) == grid_of([0.0]) == 0.0
    assert grid_of([0.0, 1.0]) == SHARE
