"""The oracles of motion against closed forms: steady precession, energy, rows of balls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.oracle.balls_on_a_line import Line
from tests.oracle.rolling_motion import GRAVITY, disc, on_a_tip

TOLERANCE = 1e-9  # the ODEs are integrated to 1e-11


def leaning(degrees: float) -> np.ndarray:
    return Rotation.from_euler("y", degrees, degrees=True).as_matrix()


def test_top_precesses_at_the_rates_of_lagrange() -> None:
    """A W^2 cos - C s W + m g l = 0 for spin s about the axis, A about the tip (Lagrange)."""
    about, along, length, tilt, spin = 0.002, 0.001, 0.1, math.radians(25), 300.0
    top = on_a_tip((about, about, along), (0, 0, -length), 0.0)
    tip = about + length**2
    squared = (along * spin) ** 2 - 4.0 * tip * math.cos(tilt) * GRAVITY * length
    rate = (along * spin - math.sqrt(squared)) / (2.0 * tip * math.cos(tilt))
    turn = leaning(25)
    start = rate * np.array([0, 0, 1.0]) + (spin - rate * math.cos(tilt)) * turn[:, 2]
    way, end, _ = top.after(1.3, turn, start)
    turned = Rotation.from_euler("z", 1.3 * rate).as_matrix() @ turn[:, 2]
    np.testing.assert_allclose(end[:, 2], turned, atol=TOLERANCE)
    np.testing.assert_allclose(way, length * (turned - turn[:, 2]), atol=TOLERANCE)


@pytest.mark.parametrize(
    "body", [disc(0.05, 0.005), on_a_tip((2e-3, 2e-3, 1e-3), (0, 0, -0.1), 0.01)]
)
def test_what_rolls_keeps_its_energy(body) -> None:
    turn, spin = leaning(30), np.array([-10.0, 3.0, 20.0])
    _, end, last = body.after(0.4, turn, spin)
    assert body.energy(end, last) == pytest.approx(body.energy(turn, spin), rel=TOLERANCE)


def test_steady_rolling_stays_steady() -> None:
    turn, body = leaning(60), disc(0.05, 0.005)
    rate = body.steady(turn, -4.0)
    start = rate * (np.array([0, 0, 1.0]) - 4.0 * turn[:, 2])
    _, end, _ = body.after(1.0, turn, start)
    assert end[2, 2] == pytest.approx(turn[2, 2], abs=TOLERANCE)


def test_balls_of_one_mass_swap_velocities_whatever_the_gaps() -> None:
    line = Line(np.ones(4), np.full(4, 0.05))
    place = np.array([0.0, 0.2, 0.30001, 0.5])
    _, velocity = line.after(2.0, place, np.array([1.0, 0, 0, 0]))
    np.testing.assert_allclose(velocity, [0, 0, 0, 1], atol=1e-15)


def test_light_ball_on_a_heavy_one_leaves_at_three_times_the_speed() -> None:
    line = Line(np.array([1e9, 1.0]), np.array([0.1, 0.1]), gravity=GRAVITY, floor=True)
    place = np.array([1.1, 1.3 + 1e-9])
    x, v = line.after(math.sqrt(2.0 / GRAVITY) + 1e-3, place, np.zeros(2))
    energy = 0.5 * v[1] ** 2 + GRAVITY * (x[1] - 0.3)
    # The masses are 1e9 to 1, the gap 1e-9 m.
    assert energy == pytest.approx(9.0 * GRAVITY, rel=1e-7)


def test_ball_bounces_with_its_restitution() -> None:
    line = Line(np.ones(1), np.array([0.1]), restitution=0.5, gravity=GRAVITY, floor=True)
    fall = math.sqrt(2.0 / GRAVITY)
    x, v = line.after(1.5 * fall, np.array([1.1]), np.zeros(1))  # its next apex
    assert (x[0], v[0]) == pytest.approx((0.1 + 0.25, 0.0), abs=1e-12)
