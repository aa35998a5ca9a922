"""Cohesion: a closed contact holds tension up to F, and friction mu (N + F).

pull-off          |load| <= F stays, above it separates
Coulomb           |lambda_t| <= mu (N + F) dt, N the net load
separation        v' = max(v - F dt (1/m_A + 1/m_B), 0) of two bodies that move apart
"""

from __future__ import annotations

from math import atan, cos, sin, tan

import numpy as np
import pytest
from laboratory import Bench, box, plane, resolved, sphere

G, DT = 9.81, 1.0 / 240.0
RADIUS, MASS = 0.1, 2.0
SHARP = {"solver": "adaptive", "sweeps": 400, "tolerance": 1e-13}


def hanging(force: float, **numerics) -> Bench:
    """A ball below a ceiling that draws it with `force` [N]."""
    bodies = {
        "ceiling": plane((0.0, 0.0, -1.0), -1.0, cohesion=force),
        "ball": sphere(RADIUS, (0.0, 0.0, 1.0 - RADIUS), mass=MASS, cohesion=force),
    }
    return Bench(resolved(bodies, (0.0, 0.0, -G), **numerics), None)


def test_a_ball_hangs_as_long_as_the_force_carries_it() -> None:
    bench = hanging(MASS * G * (1.0 + 1e-6))
    rows = bench.run(240)
    # Its weight is subtracted and given back in each step: nothing is left but round-off of g dt.
    np.testing.assert_allclose(bench.velocity[1], 0.0, atol=1e-16)
    net = rows.contact["impulse_n"] - rows.contact["adhesive_impulse"]
    # The ceiling is A and the normal points down: gravity pulls the ball along it.
    np.testing.assert_allclose(net, -MASS * G * DT, rtol=1e-13)


def test_a_ball_falls_where_the_force_does_not_carry_it() -> None:
    hanging_by_too_little = hanging(MASS * G * (1.0 - 1e-6))
    hanging_by_too_little.run(240)
    assert hanging_by_too_little.engine.bodies["z"][1] < 1.0 - RADIUS - 0.1


def test_an_open_contact_pulls_no_more() -> None:
    """Half the weight in the first step, and none once the gap is wider than touching is."""
    bench = hanging(0.5 * MASS * G)
    speeds = []
    for _ in range(10):
        bench.run(1)
        speeds.append(bench.velocity[1, 2])
    expected = [-0.5 * G * DT - k * G * DT for k in range(10)]
    np.testing.assert_allclose(speeds, expected, rtol=1e-14)


def test_what_the_force_does_not_carry_falls_by_the_mean_of_its_velocities() -> None:
    """As free fall under the midpoint rule: x_k = a (k dt)^2 / 2 while the contact is closed."""
    a = 1e-4 * G
    bench = hanging(MASS * (G - a), integrator="midpoint", speculative=True, slop=0.001)
    for k in range(1, 121):
        bench.run(1)
        fallen = 1.0 - RADIUS - bench.engine.bodies["z"][1]
        # Of 0.9 m, rounded in each step.
        assert fallen == pytest.approx(0.5 * a * (k * DT) ** 2, abs=k * 2.3e-16)


@pytest.mark.parametrize("share", [0.5, 0.999, 1.001, 3.0])
def test_two_balls_part_with_what_the_force_leaves(share: float) -> None:
    """They move apart at a multiple of what the force takes from them in a step."""
    force, light, heavy = 3.0, 0.5, 2.0
    taken = force * DT * (1.0 / light + 1.0 / heavy)
    bodies = {
        "light": sphere(RADIUS, (0.0, 0.0, 0.0), mass=light, cohesion=force),
        "heavy": sphere(
            RADIUS,
            (2.0 * RADIUS, 0.0, 0.0),
            mass=heavy,
            cohesion=force,
            velocity=(share * taken, 0.0, 0.0),
        ),
    }
    bench = Bench(resolved(bodies), None)
    bench.run(1)
    apart = bench.velocity[1, 0] - bench.velocity[0, 0]
    # The force draws together, and no further than to rest.
    assert apart == pytest.approx(max(share - 1.0, 0.0) * taken, abs=1e-16)
    momentum = light * bench.velocity[0] + heavy * bench.velocity[1]
    np.testing.assert_allclose(momentum, [heavy * share * taken, 0.0, 0.0], atol=1e-16)


def on_a_slope(tangent: float, force: float, mu: float) -> Bench:
    """A flat box of 1 kg on a floor, under gravity that leans by a tangent; four contacts."""
    lean = atan(tangent)
    bodies = {
        "floor": plane(friction=mu, cohesion=force),
        "box": box((0.4, 0.4, 0.05), (0.0, 0.0, 0.025), mass=1.0, friction=mu, cohesion=force),
    }
    gravity = (G * sin(lean), 0.0, -G * cos(lean))
    return Bench(resolved(bodies, gravity, **SHARP), None)


MU, SLOPE = 0.5, tan(np.pi / 3.0)  # 60 degrees; without cohesion it holds up to 26.6 degrees
NEEDED = (G * sin(np.pi / 3.0) / MU - G * cos(np.pi / 3.0)) / 4.0  # 3.02 N in each contact


def test_a_slope_beyond_the_angle_of_friction_is_held() -> None:
    bench = on_a_slope(SLOPE, 1.01 * NEEDED, MU)
    rows = bench.run(60).contact
    # Sweeps stop at 1e-13 m/s: sixty steps of as much.
    np.testing.assert_allclose(bench.velocity[1], 0.0, atol=60e-13)
    net = rows["impulse_n"] - rows["adhesive_impulse"]
    loads = [net[rows["step"] == step].sum() for step in (1, 60)]
    np.testing.assert_allclose(loads, G * cos(np.pi / 3.0) * DT, rtol=1e-9)


def test_a_block_slides_with_the_friction_of_load_and_cohesion() -> None:
    """a = g sin - mu (g cos + 4 F / m)."""
    force = 0.8 * NEEDED
    bench = on_a_slope(SLOPE, force, MU)
    bench.run(60)
    a = G * sin(np.pi / 3.0) - MU * (G * cos(np.pi / 3.0) + 4.0 * force)
    assert a > 1.0
    assert bench.velocity[1, 0] == pytest.approx(60 * DT * a, rel=1e-9)


def test_a_surface_without_cohesion_sticks_to_nothing() -> None:
    bodies = {
        "ceiling": plane((0.0, 0.0, -1.0), -1.0),
        "ball": sphere(RADIUS, (0.0, 0.0, 1.0 - RADIUS), cohesion=1e3),
    }
    plan = Bench(resolved(bodies, (0.0, 0.0, -G)), None).spec
    assert "cohesion" not in plan.effects
