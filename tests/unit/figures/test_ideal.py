"""The line of an ideal: the closed form at every place between swept values, where it has one."""

from __future__ import annotations

import numpy as np
import pytest
from synthetic import SyntheticCell, ball_and_floor, trace_of

from lavendersim.figures.ideal import POINTS, ideal_line
from lavendersim.figures.specs.ideal import Ideal
from lavendersim.measures.specs.base import ClosedForm

WEIGHT = Ideal(closed_form=ClosedForm(form="weight", bodies=("ball",)), label="weight")
MASS = "scene.bodies.ball.mass"
GRAVITY = 9.81


def cell(mass: float, **more: float) -> SyntheticCell:
    """A ball of a mass; by the axis `pull`, gravity is scaled as well."""
    config = ball_and_floor(mass=mass)
    if "pull" in more:
        config["scene"]["gravity"] = [0.0, 0.0, -GRAVITY * more["pull"]]
    return SyntheticCell({"mass": mass, **more}, trace_of([0.0] * 2, resolved=config))


@pytest.mark.parametrize("log_x", [False, True])
def test_between_cells_the_form_is_that_of_the_number_there(log_x: bool) -> None:
    cells = [cell(8.0), cell(1.0), cell(2.0)]
    places, values = ideal_line(WEIGHT, cells, "mass", MASS, log_x)
    assert len(places) == 2 * POINTS
    np.testing.assert_allclose(values, GRAVITY * places, rtol=1e-14)
    steps = np.diff(np.log(places[:POINTS]) if log_x else places[:POINTS])
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)


@pytest.mark.parametrize("path", [None, "scene.bodies.ball.mas", "scene.bodies.7.mass"])
def test_without_a_place_for_the_number_the_line_goes_from_cell_to_cell(path: str | None) -> None:
    places, values = ideal_line(WEIGHT, [cell(4.0), cell(1.0)], "mass", path, False)
    assert places.tolist() == [1.0, 4.0]
    np.testing.assert_allclose(values, [GRAVITY, 4.0 * GRAVITY])


def test_where_the_number_moves_other_things_too_the_line_is_straight() -> None:
    """With the mass pulls change: the left cell with the right mass is not the right cell."""
    pair = [cell(1.0), cell(2.0)]
    pair[1].log.resolved["scene"]["gravity"] = [0.0, 0.0, -2.0 * GRAVITY]
    places, values = ideal_line(WEIGHT, pair, "mass", MASS, False)
    assert places.tolist() == [1.0, 2.0]
    np.testing.assert_allclose(values, [GRAVITY, 4.0 * GRAVITY])


def test_over_other_axes_the_mean_is_drawn() -> None:
    cells = [cell(mass, pull=pull) for mass in (1.0, 2.0) for pull in (1.0, 3.0)]
    places, values = ideal_line(WEIGHT, cells, "mass", MASS, False)
    assert len(places) == POINTS
    np.testing.assert_allclose(values, 2.0 * GRAVITY * places, rtol=1e-14)
    # a group that ends before the others would bend the mean there
    short = [*cells[:3]]
    places, values = ideal_line(WEIGHT, short, "mass", MASS, False)
    np.testing.assert_allclose(values, GRAVITY * places, rtol=1e-14)


def test_a_component_of_a_vector_is_a_place() -> None:
    cells = [SyntheticCell({"g": -g}, trace_of([0.0] * 2, resolved=_pulled(g))) for g in (1.0, 5.0)]
    places, values = ideal_line(WEIGHT, cells, "g", "scene.gravity.2", False)
    assert len(places) == POINTS
    np.testing.assert_allclose(values, -2.0 * places, rtol=1e-14)  # 2 kg


def _pulled(strength: float) -> dict:
    config = ball_and_floor()
    config["scene"]["gravity"] = [0.0, 0.0, -strength]
    return config


@pytest.mark.parametrize("log_x", [False, True])
def test_a_formula_has_the_numbers_between_cells_for_its_axis(log_x: bool) -> None:
    """Whatever the axis varies: a formula knows nothing of the scene."""
    ideal = Ideal(value="3 * $mass**2 / $pull", label="law")
    cells = [cell(mass, pull=2.0) for mass in (8.0, 1.0, 2.0)]
    places, values = ideal_line(ideal, cells, "mass", None, log_x)
    assert len(places) == 2 * POINTS
    np.testing.assert_allclose(values, 1.5 * places**2, rtol=1e-14)


def test_where_a_formula_has_no_value_its_line_has_a_gap() -> None:
    ideal = Ideal(value="sqrt($mass - 2)", label="law")
    places, values = ideal_line(ideal, [cell(1.0), cell(4.0)], "mass", None, False)
    np.testing.assert_array_equal(np.isnan(values), places < 2.0)
    np.testing.assert_allclose(values[places >= 2.0], np.sqrt(places[places >= 2.0] - 2.0))


def test_an_ideal_is_a_number_in_every_cell_as_well() -> None:
    places, values = ideal_line(
        Ideal(value=0.25, label="a"), [cell(1.0), cell(4.0)], "mass", None, False
    )
    assert set(values.tolist()) == {0.25}
    assert places[[0, -1]].tolist() == [1.0, 4.0]
