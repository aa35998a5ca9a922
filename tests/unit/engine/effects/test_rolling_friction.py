"""Rolling friction: a ball that rolls slows down, and one on a slope gentle enough stays.

Rolling along x on a floor, with the friction force f and the load N = m g:
    m a = f,   I a/r = -r f - c N      (the torque c N opposes the rolling)
    a = -(c/r) g / (1 + I/(m r^2))
On a slope, N = m g cos and the weight pulls with m g sin:
    a = g (sin - (c/r) cos) / (1 + I/(m r^2)),   rest up to tan = c/r.
"""

from __future__ import annotations

from math import atan, cos, sin

import numpy as np
import pytest
from laboratory import Bench, plane, resolved, sphere

G, DT = 9.81, 1.0 / 240.0
RADIUS, MASS, C, MU = 0.1, 2.0, 0.002, 0.5
# I/(m r^2) of a homogeneous ball.
SHARE = 0.4
# Friction and rolling friction answer each other; a sweep leaves (r^2/I)/(1/m + r^2/I) = 0.71 of
# what is wrong. 300 sweeps: round-off.
SOLVED = {"sweeps": 300, "tolerance": 1e-15}


def rolling(speed: float, angle: float = 0.0, heading: float = 0.0, c: float = C) -> Bench:
    """A ball at the origin of a plane that falls along x by `angle`; rolls towards `heading`."""
    normal = np.array([sin(angle), 0.0, cos(angle)])
    down = np.array([cos(angle), 0.0, -sin(angle)])
    along = speed * (cos(heading) * down + sin(heading) * np.array([0.0, 1.0, 0.0]))
    bodies = {
        "floor": plane(normal=tuple(normal), rolling_friction=c, friction=MU),
        "ball": sphere(
            RADIUS,
            tuple(RADIUS * normal),
            mass=MASS,
            velocity=tuple(along),
            angular_velocity=tuple(np.cross(normal, along) / RADIUS),
            friction=MU,
        ),
    }
    return Bench(resolved(bodies, (0.0, 0.0, -G), **SOLVED))


def velocities(bench: Bench, steps: int) -> tuple[np.ndarray, np.ndarray]:
    found = []
    for _ in range(steps):
        bench.run(1)
        found.append((bench.velocity[1].copy(), bench.spin[1].copy()))
    moving, turning = zip(*found, strict=True)
    return np.array(moving), np.array(turning)


@pytest.mark.parametrize("heading", [0.0, 0.5, 2.0])
def test_a_rolling_ball_slows_by_its_closed_form_straight_ahead(heading: float) -> None:
    """Every step subtracts a dt; 120 steps solved to 1e-15 m/s, by three sweeps' worth of it."""
    speed = 0.05
    slowing = C / RADIUS * G / (1.0 + SHARE)
    moving, turning = velocities(rolling(speed, heading=heading), 120)
    expected = np.maximum(speed - slowing * DT * np.arange(1, 121), 0.0)
    assert speed / slowing < 100 * DT  # it stops within the run
    ahead = np.array([cos(heading), sin(heading), 0.0])
    np.testing.assert_allclose(moving, np.outer(expected, ahead), atol=1e-12)
    axis = np.array([-sin(heading), cos(heading), 0.0]) / RADIUS
    np.testing.assert_allclose(turning, np.outer(expected, axis), atol=1e-11)


def test_a_ball_rests_on_slopes_up_to_c_over_r() -> None:
    moving, turning = velocities(rolling(0.0, atan(0.98 * C / RADIUS)), 120)
    np.testing.assert_allclose(moving, 0.0, atol=1e-13)
    np.testing.assert_allclose(turning, 0.0, atol=1e-12)


def test_a_ball_rolls_down_steeper_slopes_by_what_is_left_of_its_weight() -> None:
    angle = atan(1.02 * C / RADIUS)
    moving, _ = velocities(rolling(0.0, angle), 120)
    gained = G * (sin(angle) - C / RADIUS * cos(angle)) / (1.0 + SHARE)
    expected = gained * DT * np.arange(1, 121)
    np.testing.assert_allclose(moving[:, 0], expected * cos(angle), atol=1e-12)
    np.testing.assert_allclose(moving[:, 2], -expected * sin(angle), atol=1e-12)


def test_angular_impulse_is_a_disc_that_opposes_the_turning() -> None:
    rows = rolling(0.05, heading=0.7).run(60).contact
    impulse = np.column_stack([rows["angular_impulse_t1"], rows["angular_impulse_t2"]])
    spin = np.column_stack([rows["spin_t1"], rows["spin_t2"]])
    limit = C * rows["impulse_n"]
    size = np.linalg.norm(impulse, axis=1)
    np.testing.assert_allclose(size, limit, rtol=1e-12)  # it rolls all the time
    aligned = np.einsum("ij,ij->i", impulse, spin)
    np.testing.assert_allclose(aligned, -size * np.linalg.norm(spin, axis=1), rtol=1e-12)


def test_without_rolling_friction_a_ball_rolls_on() -> None:
    moving, _ = velocities(rolling(0.05, c=0.0), 120)
    np.testing.assert_allclose(moving, [[0.05, 0.0, 0.0]] * 120, atol=1e-14)
