"""Curves over time: of a body where they are of one, and what they take of a log."""

from __future__ import annotations

from typing import get_args

import pytest
from pydantic import ValidationError
from swept_pages import LABELS

from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.figures.specs.time_series import OF_COLUMNS, Column, TimeSeries
from lavendersim.quantities.readings import CONTACTS, POSES, SUMS, VELOCITIES


def test_a_coordinate_of_no_body_is_refused() -> None:
    panel = LABELS | {"kind": "time_series", "column": "position_z"}
    with pytest.raises(ValidationError, match="expected key `body`"):
        FigureSpec.model_validate({"caption": "See.", "panels": (panel,)})


def test_a_clearance_is_above_a_plane() -> None:
    panel = LABELS | {"kind": "time_series", "column": "clearance", "body": "ball"}
    with pytest.raises(ValidationError, match="expected key `above`"):
        TimeSeries.model_validate(panel)
    assert TimeSeries.model_validate(panel | {"above": "floor"}).above == "floor"


@pytest.mark.parametrize(
    ("given", "taken"),
    [
        ({"column": "kinetic_energy"}, SUMS),
        ({"column": "kinetic_energy", "start": "first_contact"}, CONTACTS),
        ({"column": "position_x", "start": "first_contact"}, POSES | CONTACTS),
        ({"column": "angular_velocity_z"}, VELOCITIES),
        ({"column": "penetration"}, CONTACTS),
        ({}, SUMS),
    ],
)
def test_what_a_curve_takes(given: dict[str, str | None], taken: frozenset[str]) -> None:
    assert TimeSeries.reads(given) == taken
    assert set(get_args(Column)) >= OF_COLUMNS.keys()
