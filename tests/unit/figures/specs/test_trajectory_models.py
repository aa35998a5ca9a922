"""A trajectory has two different coordinates, and takes the poses of every step."""

from __future__ import annotations

import itertools

import pytest
from pydantic import ValidationError
from swept_pages import LABELS

from lavendersim.figures.specs.trajectory import Trajectory
from lavendersim.quantities.readings import POSES


@pytest.mark.parametrize(("x", "y"), list(itertools.product("xyz", repeat=2)))
def test_two_coordinates_differ(x: str, y: str) -> None:
    given = LABELS | {"kind": "trajectory", "x": x, "y": y}
    if x != y:
        assert (Trajectory.model_validate(given).x, Trajectory.model_validate(given).y) == (x, y)
        return
    with pytest.raises(ValidationError, match="expected two different coordinates as x and y"):
        Trajectory.model_validate(given)


def test_seen_from_the_side_where_nothing_is_said() -> None:
    panel = Trajectory.model_validate(LABELS | {"kind": "trajectory"})
    assert (panel.x, panel.y, panel.equal) == ("x", "z", True)
    assert panel.reads({}) == POSES
