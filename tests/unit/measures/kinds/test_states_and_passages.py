"""Components, first passages, fallen bodies and energies on states whose answers are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError
from synthetic import log_of, scene_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs import states as specs

CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": 1.0}
TWO = scene_of({"one": CUBE, "two": CUBE})


def log(heights: Any, turns: Any = None) -> Any:
    """Two cubes at 100 Hz: their heights, state by state, and how far they lean about x."""
    heights = np.asarray(heights, dtype=float)
    places = np.zeros((*heights.shape, 3))
    places[:, :, 2] = heights
    if turns is None:
        return log_of(TWO, places)
    half = 0.5 * np.radians(np.asarray(turns, dtype=float))
    quaternions = np.zeros((*half.shape, 4))
    quaternions[..., 0], quaternions[..., 1] = np.cos(half), np.sin(half)
    return log_of(TWO, places, quaternions)


FALL = [[3, 1], [2, 2], [0, 3], [-2, 4]]


def position(**keys: Any) -> Any:
    return evaluate(specs.PositionAt(kind="position", along=(0, 0, 2), **keys), log(FALL))


def test_a_component_is_that_of_the_last_state_or_of_a_time() -> None:
    assert position(body="one") == -2
    assert position(body="one", time=0.01) == 2
    assert position(body="two", time=0.015) == 3  # the first state then or later
    assert math.isnan(position(body="one", time=0.04))


def test_components_of_several_bodies_are_a_row_or_one_number() -> None:
    assert list(position()) == [-2, 4]
    assert list(position(bodies=("two", "one"))) == [4, -2]
    found = {how: position(reduce=how) for how in ("max", "min", "mean", "sum", "count")}
    assert found == {"max": 4, "min": -2, "mean": 1, "sum": 2, "count": 2}


def test_components_of_velocity_and_spin_are_those_that_the_log_has() -> None:
    """Of the body's own six numbers, along a direction of any length; not by differences."""
    moving = log(FALL)
    moving.velocity = np.arange(48.0).reshape(4, 2, 6)  # vx vy vz wx wy wz of two, in four states
    fast, along = "velocity", (3, 0, 4)
    speed = specs.VelocityAt(kind=fast, along=along, body="two", time=0.02)
    assert evaluate(speed, moving) == pytest.approx(0.6 * 30 + 0.8 * 32, rel=1e-15)
    spin = specs.AngularVelocityAt(kind="angular_velocity", along=along, reduce="max")
    assert evaluate(spin, moving) == pytest.approx(0.6 * 45 + 0.8 * 47, rel=1e-15)
    late = specs.VelocityAt(kind=fast, along=along, body="one", time=0.04)
    assert math.isnan(evaluate(late, moving))


def passage(level: float, **keys: Any) -> Any:
    spec = specs.FirstPassage(kind="first_passage", along=(0, 0, 1), level=level, **keys)
    return evaluate(spec, log([[1, 0], [-1, 3], [2, 4], [5, 1]]))


def test_a_passage_is_where_the_line_between_two_states_crosses() -> None:
    assert passage(0.0, body="one") == pytest.approx(0.005, rel=1e-12)
    assert passage(0.0, body="one", crossing="rising") == pytest.approx(0.01 + 0.01 / 3, rel=1e-12)
    assert passage(0.5, body="one", after=0.005) == pytest.approx(0.015, rel=1e-12)
    assert math.isnan(passage(9.0, body="one"))
    assert math.isnan(passage(0.0, body="two", crossing="falling"))


def test_passages_are_counted_over_bodies() -> None:
    assert passage(4.5, reduce="count") == 1  # `one` alone gets so high
    assert passage(2.5, reduce="count") == 2


def test_bodies_have_fallen_whose_axis_leans_by_more_than_the_angle() -> None:
    leaning = log(FALL, [[10, 0], [10, 30], [50, 60], [60, 170]])
    count = specs.FallenBodies(kind="fallen_bodies")
    assert evaluate(count, leaning) == 2  # 50 and 170 degrees from where they began
    assert evaluate(count.model_copy(update={"time": 0.02}), leaning) == 1  # 40 and 60
    assert evaluate(count.model_copy(update={"degrees": 175.0}), leaning) == 0
    about_its_own = count.model_copy(update={"axis": (1.0, 0.0, 0.0)})
    assert evaluate(about_its_own, leaning) == 0  # a turn about x leaves the x axis alone


def test_energies_are_parts_at_a_time_and_their_changes() -> None:
    states = log(FALL)
    states.step["kinetic_energy"] = [0, 1, 4, 9]
    states.step["potential_energy"] = [10, 9, 6, 0]

    def energy(**keys: Any) -> Any:
        return evaluate(specs.EnergyAt(kind="energy", **keys), states)

    assert energy(part="kinetic") == 9
    assert energy(part="potential", time=0.01) == 9
    assert energy(since=0.0) == -1
    assert energy(part="kinetic", time=0.02, since=0.01) == 3
    assert math.isnan(energy(time=1.0))


def test_body_and_bodies_exclude_each_other() -> None:
    with pytest.raises(ValidationError, match="at most one of body, bodies"):
        specs.PositionAt(kind="position", along=(0, 0, 1), body="one", bodies=("two",))
