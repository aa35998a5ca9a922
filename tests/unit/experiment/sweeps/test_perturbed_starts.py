"""Perturbed starts as an axis: which seeds, which cell is which start, the spread of numbers."""

from __future__ import annotations

import pytest

from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.sweeps.perturbed_starts import (
    overrides_of,
    spread_of,
    start_of,
    starts_of,
)
from tests.engines import BALL


def test_the_first_start_is_the_one_that_is_written() -> None:
    (override,) = overrides_of(3)
    swept = load_experiment_text(BALL, "ball.yaml", overrides=[override])
    places = {
        start_of(cell.coordinates): cell.config.scene.bodies["ball"].position
        for cell in swept.cells()
    }
    assert list(places) == [0, 1, 2]
    assert places[0] == (0.0, 0.0, 3.0)
    assert len({*places.values()}) == 3


def test_one_start_is_no_axis_and_none_is_refused() -> None:
    assert overrides_of(None) == overrides_of(1) == []
    assert start_of({"engine": "mujoco"}) is None
    for wrong in (0, 1001):
        with pytest.raises(UsageError, match=f"--starts: expected 1 to 1000, found {wrong}"):
            overrides_of(wrong)


def test_engines_that_are_compared_start_several_times_unless_somebody_says_otherwise() -> None:
    two = ("lavender", "mujoco")
    assert starts_of(None, two) == 3
    assert [starts_of(asked, two) for asked in (1, 5)] == [1, 5]
    assert starts_of(None, ("mujoco",)) is starts_of(None, ()) is None


def test_a_spread_is_of_several_starts() -> None:
    assert spread_of({0: 0.25}) is None
    assert spread_of({0: 0.25, 1: 0.125, 2: 0.5}) == (0.125, 0.5)
