"""Measures of motion on logged poses whose answers are known by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from synthetic import GRAVITY, ball_and_floor, contacts, log_of, scene_of, trace_of

from lavendersim.measures import evaluate
from lavendersim.measures.specs import motion as specs

DT = 0.01
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": 1.0}


def bounces(restitution: float, phase: float, count: int) -> Any:
    """The exact clearances of a ball dropped from 1 m, sampled `phase` of a step late."""
    fall = math.sqrt(2.0 / GRAVITY)
    times = (np.arange(1200) + phase) * DT
    heights = np.maximum(0.0, 1.0 - 0.5 * GRAVITY * times**2)
    start, speed = fall, GRAVITY * fall
    for _ in range(count):
        speed *= restitution
        local = times - start
        flying = (local >= 0.0) & (local < 2.0 * speed / GRAVITY)
        heights[flying] = (speed * local - 0.5 * GRAVITY * local**2)[flying]
        start += 2.0 * speed / GRAVITY
    return trace_of(heights[times < start].tolist())


@pytest.mark.parametrize("phase", [0.0, 0.3, 0.77])
@pytest.mark.parametrize("bounce", [1, 2, 4])
def test_the_apex_of_every_bounce_is_held_against_its_power_of_e(phase: float, bounce: int) -> None:
    spec = specs.ApexError(kind="apex_error", body="ball", above="floor", bounce=bounce)
    # e^2 h = 0.25 m and less, samples good to 1e-16 m; fourth apex 0.0039 m: 1e-16/0.0039 = 3e-14
    assert evaluate(spec, bounces(0.5, phase, 5)) < 1e-13


def test_an_apex_a_tenth_too_high_shows_as_a_tenth() -> None:
    log = bounces(0.5, 0.3, 2)
    log.pose[46:, 1, 2] = 0.1 + 1.1 * (log.pose[46:, 1, 2] - 0.1)
    spec = specs.ApexError(kind="apex_error", body="ball", above="floor")
    assert evaluate(spec, log) == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("heights", [[1.0, 0.5, 0.0, 0.3, 0.6], [1.0, 0.5, 0.0, 0.0, 0.0]])
def test_without_an_apex_there_is_no_error(heights: list[float]) -> None:
    spec = specs.ApexError(kind="apex_error", body="ball", above="floor")
    assert math.isnan(evaluate(spec, trace_of(heights)))


def test_the_apex_needs_no_contact_in_the_log() -> None:
    log = bounces(0.5, 0.0, 2)
    assert len(log.contact) == 0
    log.contact = contacts([(3, 1.0, 0.1)])  # nor is one believed
    spec = specs.ApexError(kind="apex_error", body="ball", above="floor")
    assert evaluate(spec, log) < 1e-13


def test_drift_is_the_furthest_centre_from_its_place_at_the_time_given() -> None:
    scene = scene_of({"floor": FLOOR, "left": CUBE, "right": CUBE})
    places = np.zeros((6, 3, 3))
    places[:, 0, 0] = [0, 9, 9, 9, 9, 9]  # the floor is not asked
    places[:, 1, 2] = [7.0, 7.0, 0.5, 0.5, 0.6, 0.5]
    places[:, 2] = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0.12, 0.16], [2, 0, 0], [2, 0, 0]]
    log = log_of(scene, places)
    spec = specs.Drift(kind="drift", after=0.02)
    assert evaluate(spec, log) == pytest.approx(0.2, rel=1e-14)
    left = spec.model_copy(update={"bodies": ("left",)})
    assert evaluate(left, log) == pytest.approx(0.1, rel=1e-14)
    assert math.isnan(evaluate(spec.model_copy(update={"after": 0.05}), log))


def test_drift_starts_at_the_row_of_its_time_though_times_are_rounded_down() -> None:
    scene = scene_of({"cube": CUBE})
    log = log_of(scene, np.array([0.0, 1.0, 1.5, 2.0])[:, None, None] * [[1.0, 0.0, 0.0]])
    log.step["time"][1] = 0.009999999
    assert evaluate(specs.Drift(kind="drift", after=0.01), log) == 1.0


def sliding(slope: float, azimuth: float, mu: float | None) -> Any:
    """A cube on a floor under tilted gravity; it slides with mu from 0.3 m/s, or holds for None."""
    angle = math.atan(slope)
    along = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    pull = GRAVITY * (math.sin(angle) * along - math.cos(angle) * np.array([0.0, 0.0, 1.0]))
    scene = scene_of({"floor": FLOOR, "cube": CUBE}, gravity=pull.tolist())
    times = np.arange(101) * DT
    rate = 0.0 if mu is None else GRAVITY * (math.sin(angle) - mu * math.cos(angle))
    gone = 0.0 * times if mu is None else 0.3 * times + 0.5 * rate * times**2
    places = np.zeros((101, 2, 3))
    places[:, 1] = [0.0, 0.0, 0.1] + gone[:, None] * along
    return log_of(scene, places)


@pytest.mark.parametrize("azimuth", [0.0, 0.4, 2.5])
@pytest.mark.parametrize("last", [0.5, 0.51, 1.0])
def test_a_sliding_body_tells_its_friction(azimuth: float, last: float) -> None:
    spec = specs.EffectiveFriction(kind="effective_friction", body="cube", on="floor", last=last)
    # places of 1 m good to 2e-16, over (0.25 s)^2, by 9 m/s^2: 1e-15
    assert evaluate(spec, sliding(0.55, azimuth, 0.5)) == pytest.approx(0.5, abs=1e-14)
    assert evaluate(spec, sliding(0.55, azimuth, None)) == pytest.approx(0.55, abs=1e-15)


def test_without_a_slope_there_is_no_friction_to_tell() -> None:
    spec = specs.EffectiveFriction(kind="effective_friction", body="cube", on="floor", last=0.5)
    assert math.isnan(evaluate(spec, sliding(0.0, 0.0, None)))


def test_slip_and_creep_are_taken_between_the_ends_of_the_window() -> None:
    log = sliding(0.55, 0.4, 0.55)  # 0.3 m/s without acceleration
    slip = specs.SlipDistance(kind="slip_distance", body="cube", last=0.5)
    creep = specs.Creep(kind="creep", body="cube", last=0.5)
    assert evaluate(slip, log) == pytest.approx(0.15, rel=1e-13)
    assert evaluate(creep, log) == pytest.approx(0.3, rel=1e-13)
    whole = creep.model_copy(update={"last": 1.0})
    assert evaluate(whole, log) == pytest.approx(0.3, rel=1e-13)
    assert math.isnan(evaluate(creep.model_copy(update={"last": 2.0}), log))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(("nearest", "passed"), [(0.06, -0.06), (0.0, 0.0), (-0.4, 0.4)])
def test_a_wall_is_passed_by_the_centre_behind_its_middle(
    side: float, nearest: float, passed: float
) -> None:
    turned = [math.cos(0.3), 0.0, 0.0, math.sin(0.3)]
    normal = np.array([math.cos(0.6), math.sin(0.6), 0.0])
    wall = {
        "shape": {"kind": "box", "size": [0.02, 2.0, 2.0]},
        "position": [3.0, 0.0, 0.0],
        "orientation": turned,
    }
    ball = {"shape": {"kind": "sphere", "radius": 0.05}, "mass": 1.0}
    # it flies a little aside, too, which is none of the wall's business
    distances = [2.0, nearest, 1.0 if nearest >= 0 else nearest]
    rows = [
        [(3, 0, 0), side * distance * normal + [3.0, 0.0, 0.1 * k]]
        for k, distance in enumerate(distances)
    ]
    log = log_of(scene_of({"wall": wall, "ball": ball}), rows)
    spec = specs.PassedThrough(kind="passed_through", body="ball", wall="wall")
    assert evaluate(spec, log) == pytest.approx(passed, abs=1e-15)


def test_a_plane_is_passed_at_its_surface() -> None:
    spec = specs.PassedThrough(kind="passed_through", body="ball", wall="floor")
    # clearances of a ball of 0.1 m: the centre is 0.1 m higher
    assert evaluate(spec, trace_of([1.0, -0.02, 0.5])) == pytest.approx(-0.08, rel=1e-14)
    assert evaluate(spec, trace_of([1.0, -0.2, 0.5])) == pytest.approx(0.1, rel=1e-14)


def test_a_body_that_starts_inside_a_wall_has_no_answer() -> None:
    wall = {"shape": {"kind": "box", "size": [1.0, 2.0, 2.0]}, "position": [0.0, 0.0, 0.0]}
    log = log_of(scene_of({"wall": wall, "cube": CUBE}), [[(0, 0, 0), (0.1, 0, 0)]] * 2)
    spec = specs.PassedThrough(kind="passed_through", body="cube", wall="wall")
    assert math.isnan(evaluate(spec, log))


def test_a_ball_without_bounce_has_no_apex_to_be_held_against() -> None:
    log = bounces(0.5, 0.0, 2)
    log.resolved = ball_and_floor(surface={"restitution": 0.0})
    spec = specs.ApexError(kind="apex_error", body="ball", above="floor")
    assert math.isnan(evaluate(spec, log))
