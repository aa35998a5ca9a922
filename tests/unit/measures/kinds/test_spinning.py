"""Distances from rigid motion: the exact motion has none, a slow clock and a wrong moment show."""

from __future__ import annotations

import math

import numpy as np
import pytest
from synthetic import log_of, scene_of, spinning_log

from lavendersim.measures import evaluate
from lavendersim.measures.free_rotation import free_rotation
from lavendersim.measures.kinds.spinning import body_rates, crossings
from lavendersim.measures.specs import spinning as specs


def test_a_crossing_is_found_between_samples() -> None:
    times = np.arange(40.0)
    # a sine with 40 samples per period; the cubic's error is 9/16 (2 pi/40)^4/24 = 1.4e-5 of the
    # amplitude at most, and 1/(2 pi/40) as much in samples
    found = crossings(np.sin(2.0 * math.pi * (times + 0.3) / 40.0))
    np.testing.assert_allclose(found, [19.7], atol=1e-4)
    assert len(crossings(np.ones(5))) == 0


RATE = specs.AngularVelocityError(kind="angular_velocity_error", body="top")
FLIP = specs.FlipTimeError(kind="flip_time_error", body="top", flips=3)


def test_the_exact_motion_has_no_error() -> None:
    # orbital part taken off: 1e-15; samples 1/100 s, rate 2.9/s: the cubic's error is
    # (0.029)^4 0.6/24 = 2e-8 of omega, over its slope of 14 rad/s^2: 6e-9 s
    assert evaluate(RATE, spinning_log()) < 1e-13
    assert evaluate(FLIP, spinning_log()) < 6e-9


def test_a_clock_a_thousandth_slow_shifts_the_flips_by_a_thousandth() -> None:
    log = spinning_log(slow=1e-3)
    third = free_rotation(np.array([1.0, 2.0, 3.0]), np.array([0.01, 5.0, 0.01])).flip_times(3)[2]
    assert evaluate(FLIP, log) == pytest.approx(third / 999.0, rel=1e-4)
    until = RATE.model_copy(update={"until": 1.0})
    assert evaluate(until, log) < 1e-2 < evaluate(RATE, log)


def test_fewer_flips_than_asked_for_are_no_answer() -> None:
    assert math.isnan(evaluate(FLIP.model_copy(update={"flips": 9}), spinning_log()))


def test_a_second_movable_body_makes_the_sums_useless() -> None:
    log = spinning_log()
    scene = log.resolved["scene"]
    scene["bodies"]["other"] = scene["bodies"]["top"]
    assert math.isnan(evaluate(RATE, log))


def test_a_wrong_moment_shows() -> None:
    log = spinning_log()
    log.resolved["scene"]["bodies"]["top"]["inertia"] = [1.0, 2.0, 3.001]
    assert evaluate(RATE, log) > 1e-4


def test_rates_in_body_axes_are_of_the_turned_body() -> None:
    """A box turned by 90 degrees about z, at (1, 0, 0), moving along y: L = r x p + R I R^T w."""
    turn = [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
    box = {
        "shape": {"kind": "box", "size": [1.0, 1.0, 1.0]},
        "mass": 2.0,
        "inertia": [1.0, 2.0, 3.0],
    }
    log = log_of(scene_of({"it": box}), [[[1.0, 0.0, 0.0]]], [[turn]])
    # w = (0, 0, 5) and (4, 0, 0) in the world; the body's y points along -x there
    momentum = {"x": 2.0 * 4.0, "y": 0.0, "z": 3.0 * 5.0 + 1.0 * 2.0 * 7.0}
    dtype = [*log.step.dtype.descr, *((f"angular_momentum_{axis}", "f8") for axis in "xyz")]
    log.step = np.zeros(1, dtype)
    for axis, value in momentum.items():
        log.step[f"angular_momentum_{axis}"] = value
    log.step["momentum_y"] = 2.0 * 7.0
    np.testing.assert_allclose(
        body_rates(log, "it"), [[0.0, -4.0, 5.0]], atol=4e-15
    )  # a few roundings of 8
