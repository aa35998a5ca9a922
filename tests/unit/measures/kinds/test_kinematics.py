"""Ways, speeds, turns and times of rest on logged poses whose answers are known by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError
from synthetic import log_of, scene_of

from lavendersim.errors import UsageError
from lavendersim.measures import evaluate
from lavendersim.measures.specs import kinematics as specs

CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": 1.0}
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
HALF = math.sqrt(0.5)


def moving(places: Any, quaternions: Any = None) -> Any:
    """A cube's centres at 100 Hz, and its orientations where they matter."""
    turns = None if quaternions is None else np.asarray(quaternions, dtype=float)[:, None, :]
    return log_of(scene_of({"cube": CUBE}), np.asarray(places, dtype=float)[:, None, :], turns)


def turning(rate: float, axis: Any, count: int) -> Any:
    """A cube that turns about an axis at a rate [rad/s], at 100 Hz."""
    half = 0.5 * rate * np.arange(count) / 100.0
    turns = np.column_stack([np.cos(half), np.sin(half)[:, None] * np.asarray(axis)])
    return moving(np.zeros((count, 3)), turns)


def test_a_way_is_counted_along_its_direction_with_its_sign() -> None:
    log = moving([[9, 9, 9], [0, 0, 0], [3, 4, 7], [6, 8, 7]])
    spec = {"kind": "displacement", "body": "cube", "from": 0.01, "to": 0.03, "along": [3, 4, 0]}
    assert evaluate(specs.Displacement.model_validate(tupled(spec)), log) == pytest.approx(10.0)
    back = spec | {"along": [-30, -40, 0]}
    assert evaluate(specs.Displacement.model_validate(tupled(back)), log) == pytest.approx(-10.0)
    over_time = spec | {"kind": "mean_velocity"}
    assert evaluate(specs.MeanVelocity.model_validate(tupled(over_time)), log) == pytest.approx(500)


def test_a_way_beyond_the_end_of_the_run_is_not_known() -> None:
    spec = {"kind": "displacement", "body": "cube", "to": 0.04, "along": [1, 0, 0]}
    log = moving(np.zeros((4, 3)))
    assert math.isnan(evaluate(specs.Displacement.model_validate(tupled(spec)), log))


def test_a_centre_of_mass_is_weighed_and_its_mean_is_over_time() -> None:
    bodies = {"light": CUBE, "heavy": CUBE | {"mass": 3.0}}
    places = [[[0, 0, 0], [4, 0, 0]], [[0, 0, 0], [8, 0, 0]], [[0, 0, 0], [8, 0, 0]]]
    log = log_of(scene_of(bodies), places)
    spec = {"kind": "centre_of_mass", "along": [2, 0, 0]}

    def found(**more: Any) -> float:
        return evaluate(specs.CentreOfMass.model_validate(tupled(spec | more)), log)

    # 3 m, then 6 m; the mean over the first step of two is 4.5 m
    assert found() == pytest.approx(0.5 * (4.5 + 6.0), rel=1e-14)
    assert found(bodies=("light",)) == 0.0
    assert found(bodies=("light", "heavy", "light")) == found()  # each has one mass
    assert found(bodies=("heavy",), **{"from": 0.01}) == pytest.approx(8.0, rel=1e-14)
    assert math.isnan(found(to=1.0))
    with pytest.raises(ValidationError, match="expected `from` before `to`"):
        found(**{"from": 0.02, "to": 0.01})


def test_a_centre_of_mass_has_one_mass_of_each_body() -> None:
    bodies = {"light": CUBE, "heavy": CUBE | {"mass": 3.0}}
    change = {"body": "heavy", "at": 0.01, "scale_mass": 2.0}
    log = log_of(scene_of(bodies) | {"events": [change]}, np.zeros((3, 2, 3)))
    spec = {"kind": "centre_of_mass", "along": (1.0, 0.0, 0.0)}
    with pytest.raises(UsageError, match="an event changes heavy's"):
        evaluate(specs.CentreOfMass.model_validate(spec), log)
    assert evaluate(specs.CentreOfMass.model_validate(spec | {"bodies": ("light",)}), log) == 0.0


@pytest.mark.parametrize("rate", [-200.0, 1e-6, 3.0, 300.0])
def test_turns_add_up_to_the_rate(rate: float) -> None:
    log = turning(rate, [0.0, HALF, HALF], 40)
    spec = {"kind": "mean_angular_velocity", "body": "cube", "along": [0, 0, 5]}
    # a turn of 0.01 rate is good to 1e-16, its rate to 1e-14 rad/s
    found = evaluate(specs.MeanAngularVelocity.model_validate(tupled(spec)), log)
    assert found == pytest.approx(rate * HALF, rel=1e-13, abs=1e-13)


def test_the_sign_of_a_quaternion_says_nothing_about_its_turn() -> None:
    log = turning(3.0, [0.0, 0.0, 1.0], 40)
    log.pose[::3, :, 3:] *= -1.0
    spec = {"kind": "mean_angular_velocity", "body": "cube", "along": [0, 0, 1]}
    found = evaluate(specs.MeanAngularVelocity.model_validate(tupled(spec)), log)
    assert found == pytest.approx(3.0, rel=1e-12)


def test_the_turn_is_of_the_world_frame() -> None:
    """Two quarter turns in a row, about the world's x and then z; in the body's frame x, then y."""
    turns = [[1, 0, 0, 0], [HALF, HALF, 0, 0], [0.5, 0.5, 0.5, 0.5]]
    log = moving(np.zeros((3, 3)), turns)
    for along, quarters in (([1, 0, 0], 1), ([0, 1, 0], 0), ([0, 0, 1], 1)):
        spec = {"kind": "mean_angular_velocity", "body": "cube", "along": along}
        found = evaluate(specs.MeanAngularVelocity.model_validate(tupled(spec)), log)
        assert found == pytest.approx(quarters * 0.5 * math.pi / 0.02, abs=1e-12)


def test_the_top_speed_is_that_of_the_fastest_movable_body() -> None:
    scene = scene_of({"floor": FLOOR, "left": CUBE, "right": CUBE})
    places = np.zeros((5, 3, 3))
    places[:, 0, 0] = [0, 9, 0, 9, 0]
    places[:, 1, 2] = [0, 5, 5, 5, 5]
    places[:, 2, 0] = [0, 0, 0, 0.3, 0.3]
    log = log_of(scene, places)
    assert evaluate(specs.TopSpeed(kind="top_speed"), log) == pytest.approx(500.0)
    assert evaluate(specs.TopSpeed(kind="top_speed", after=0.01), log) == pytest.approx(30.0)
    right = specs.TopSpeed(kind="top_speed", bodies=("right",))
    assert evaluate(right, log) == pytest.approx(30.0)
    assert math.isnan(evaluate(specs.TopSpeed(kind="top_speed", after=0.04), log))


def test_rest_begins_where_the_last_fast_step_ends() -> None:
    log = moving([[0, 0, 0], [1, 0, 0], [1, 0, 0], [1.5, 0, 0], [1.501, 0, 0], [1.501, 0, 0]])
    assert evaluate(specs.RestTime(kind="rest_time", slower_than=1.0), log) == pytest.approx(0.03)
    assert evaluate(specs.RestTime(kind="rest_time", slower_than=0.01), log) == pytest.approx(0.04)
    assert evaluate(specs.RestTime(kind="rest_time", slower_than=200.0), log) == 0.0


def test_what_still_moves_has_no_time_of_rest() -> None:
    log = moving([[0, 0, 0], [0, 0, 0], [1, 0, 0]])
    assert math.isnan(evaluate(specs.RestTime(kind="rest_time", slower_than=1.0), log))
    log.pose[2, 0, 0] = math.nan
    assert math.isnan(evaluate(specs.RestTime(kind="rest_time", slower_than=1.0), log))


def test_a_tilt_is_the_angle_of_an_axis_not_of_the_turn() -> None:
    log = moving(np.zeros((3, 3)), [[1, 0, 0, 0], [0, 1, 0, 0], [HALF, 0, 0, HALF]])
    upright = specs.Tilt(kind="tilt", body="cube")
    assert evaluate(upright, log) == pytest.approx(0.0, abs=1e-12)
    assert evaluate(upright.model_copy(update={"axis": (1.0, 0.0, 0.0)}), log) == pytest.approx(90)


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        (specs.Displacement, {"kind": "displacement", "from": 1.0, "to": 1.0}),
        (specs.MeanVelocity, {"kind": "mean_velocity", "along": [0, 0, 0]}),
    ],
)
def test_times_that_run_backwards_and_no_direction_are_refused(kind: Any, change: Any) -> None:
    with pytest.raises(ValidationError, match="expected"):
        kind.model_validate(tupled({"body": "cube", "along": [1, 0, 0]} | change))


def tupled(spec: dict[str, Any]) -> dict[str, Any]:
    """Lists as the loader hands them to the models."""
    return {key: tuple(value) if isinstance(value, list) else value for key, value in spec.items()}
