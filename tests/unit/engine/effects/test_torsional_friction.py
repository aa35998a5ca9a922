"""Torsional friction: a ball that spins on its pole stops, and no torque passes its limit.

On the floor lambda_n = m g dt in every step, so psi_n = c m g dt and
    omega_k = omega_0 - k c m g dt / I,   0 from omega_0 I / (c m g) on.
"""

from __future__ import annotations

import numpy as np
import pytest
from laboratory import Bench, plane, resolved, sphere

G, DT = 9.81, 1.0 / 240.0
RADIUS, MASS, SPIN, C = 0.1, 2.0, 3.0, 0.004
INERTIA = 0.4 * MASS * RADIUS**2
STOP = SPIN * INERTIA / (C * MASS * G)  # 0.306 s


def spinning(floor_c: float, ball_c: float, **numerics) -> Bench:
    bodies = {
        "floor": plane(torsional_friction=floor_c, friction=numerics.pop("mu", 0.0)),
        "ball": sphere(
            RADIUS,
            (0.0, 0.0, RADIUS),
            mass=MASS,
            angular_velocity=(0.0, 0.0, SPIN),
            torsional_friction=ball_c,
            friction=0.5,
        ),
    }
    return Bench(resolved(bodies, (0.0, 0.0, -G), **numerics))


@pytest.mark.parametrize("mu", [0.0, 0.5])
@pytest.mark.parametrize("warm_start", [True, False])
def test_spin_falls_by_the_torque_of_the_load_and_stays_zero(mu: float, warm_start: bool) -> None:
    """Each step subtracts once: 120 roundings of 3 rad/s, 120 * 4e-16; ten times that allowed."""
    bench = spinning(C, 0.0, mu=mu, warm_start=warm_start)
    found = []
    for _ in range(120):
        bench.run(1)
        found.append(bench.spin[1])
    steps = np.arange(1, 121)
    expected = np.maximum(SPIN - steps * C * MASS * G * DT / INERTIA, 0.0)
    assert 0.0 < STOP < 120 * DT
    np.testing.assert_allclose(np.array(found)[:, 2], expected, atol=5e-13)
    np.testing.assert_allclose(np.array(found)[:, :2], 0.0, atol=5e-13)


def test_a_pair_takes_the_larger_coefficient() -> None:
    rows = spinning(0.5 * C, C).run(3)
    np.testing.assert_array_equal(rows.contact["torsional_friction"], C)
    np.testing.assert_allclose(rows.contact["angular_impulse_n"], -C * MASS * G * DT, rtol=1e-14)


def test_angular_impulse_stays_in_its_limit_and_stops_no_more_than_there_is() -> None:
    rows = spinning(C, 0.0).run(120).contact
    limit = C * rows["impulse_n"]
    assert (np.abs(rows["angular_impulse_n"]) <= limit).all()
    sliding = rows["spin_n"] > 1e-12
    np.testing.assert_array_equal(rows["angular_impulse_n"][sliding], -limit[sliding])
    held = rows["angular_impulse_n"][~sliding]
    # In the step that stops it: less than the limit. Afterwards there is nothing to answer.
    assert -limit[0] < held[0] < 0.0
    np.testing.assert_allclose(held[1:], 0.0, atol=1e-16)


def test_a_twist_below_the_limit_turns_nothing() -> None:
    """A torque of 0.9 c m g is answered, one of 1.1 turns the ball by the rest of it."""
    for share, rest in ((0.9, 0.0), (1.1, 0.1)):
        bench = spinning(C, 0.0)
        bench.engine.velocities["wz"] = 0.0
        bench.engine.bodies["tz"][1] = share * C * MASS * G
        bench.run(60)
        expected = rest * C * MASS * G * 60 * DT / INERTIA
        assert bench.spin[1, 2] == pytest.approx(expected, abs=1e-13)


def test_the_cached_angular_impulse_follows_the_timestep() -> None:
    """A torque that is held costs psi = torque * dt; with dt halved the warm solve begins there."""
    bench = spinning(C, 0.0, sweeps=1)
    bench.engine.velocities["wz"] = 0.0
    torque = 0.5 * C * MASS * G
    bench.engine.bodies["tz"][1] = torque
    bench.run(5)
    bench.engine.parameters["dt"] = 0.5 * DT
    rows = bench.run(1)
    found = rows.residual["residual"]
    # Before the first sweep nothing is left to do: round-off of 0.05 rad/s times the arm.
    assert found[0] <= 1e-16
    assert rows.contact["angular_impulse_n"][0] == pytest.approx(-0.5 * torque * DT, rel=1e-13)
