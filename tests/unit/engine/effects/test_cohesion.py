"""Cohesion: a closed contact holds tension up to F, and friction mu (N + F).

pull-off          |load| <= F stays, above it separates
Coulomb           |lambda_t| <= mu (N + F) dt, N the net load
separation        v' = max(v - F dt (1/m_A + 1/m_B), 0) of two bodies that move apart
"""

from __future__ import annotations

from math import atan, cos, sin, tan
from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, planned, resolved, sphere

from lavendersim.experiment.resolve.presets import DEFAULT

G, DT = 9.81, 1.0 / 240.0
RADIUS, MASS = 0.1, 2.0
SHARP = {"solver": "adaptive", "sweeps": 400, "tolerance": 1e-13}


def balls(bodies: dict[str, Any], gravity: Any = (0.0, 0.0, 0.0), **numerics: Any) -> Bench:
    """Balls, for a few hundred steps at most."""
    cell = resolved(bodies, gravity, **numerics)
    return interpreted_bench(cell, planned(cell).spec)


def hanging(force: float, **numerics) -> Bench:
    """A ball below a ceiling that draws it with `force` [N]."""
    bodies = {
        "ceiling": plane((0.0, 0.0, -1.0), -1.0, cohesion=force),
        "ball": sphere(RADIUS, (0.0, 0.0, 1.0 - RADIUS), mass=MASS, cohesion=force),
    }
    return balls(bodies, (0.0, 0.0, -G), **numerics)


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


SLOP = 0.001


def let_go(gap: float) -> Bench:
    """A ball under a ceiling at a gap [m]; half its weight draws it, it moves along the ceiling."""
    force = 0.5 * MASS * G
    bodies = {
        "ceiling": plane((0.0, 0.0, -1.0), 0.0, cohesion=force),
        "ball": sphere(
            RADIUS, (0.0, 0.0, -RADIUS - gap), mass=MASS, cohesion=force, velocity=(2.0, 0.0, 0.0)
        ),
    }
    numerics = {"integrator": "midpoint", "speculative": True, "slop": SLOP, "projection": 0.5}
    return balls(bodies, (0.0, 0.0, -G), **numerics)


def test_a_contact_is_closed_up_to_the_slop() -> None:
    """The ball moves 8 mm along the ceiling in a step, so that the contact is there at any rate."""
    for share, acceleration, drawn in ((0.99, 0.5 * G, [0.5 * MASS * G * DT]), (1.01, G, [])):
        bench = let_go(share * SLOP)
        # In the log is what draws, though nothing touches or presses.
        np.testing.assert_array_equal(bench.run(1).contact["adhesive_impulse"], drawn)
        # One subtraction of two velocities below g dt = 0.04 m/s.
        assert bench.velocity[1, 2] == pytest.approx(-acceleration * DT, abs=2e-17)


def test_the_projection_knows_how_far_a_drawn_body_falls() -> None:
    """It falls s = (g - F/m) dt^2 / 2; half of what stays deeper than the slop is lifted."""
    depth = 0.003
    bench = let_go(-depth)
    bench.run(1)
    fallen = 0.5 * (0.5 * G) * DT**2
    expected = fallen + 0.5 * (depth - fallen - SLOP)
    # Places of 0.1 m are rounded a few times.
    found = -RADIUS + depth - bench.engine.bodies["z"][1]
    assert found == pytest.approx(expected, abs=5 * 1.4e-17)


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
    bench = balls(bodies)
    bench.run(1)
    apart = bench.velocity[1, 0] - bench.velocity[0, 0]
    # The force draws together, and no further than to rest.
    assert apart == pytest.approx(max(share - 1.0, 0.0) * taken, abs=1e-16)
    momentum = light * bench.velocity[0] + heavy * bench.velocity[1]
    np.testing.assert_allclose(momentum, [heavy * share * taken, 0.0, 0.0], atol=1e-16)


def test_two_balls_in_flight_part_under_the_pull_of_each_on_the_other() -> None:
    """x_A = F n t^2 / 2 m_A, x_B = v n t - F n t^2 / 2 m_B, both beside their fall, g t^2 / 2."""
    force, light, heavy, speed, steps = 0.03, 0.5, 2.0, 0.02, 48
    n = np.array([1.0, 2.0, 2.0]) / 3.0
    bodies = {
        "light": sphere(RADIUS, (0.0, 0.0, 0.0), mass=light, cohesion=force),
        "heavy": sphere(
            RADIUS,
            tuple((2.0 * RADIUS * n).tolist()),
            mass=heavy,
            cohesion=force,
            velocity=tuple((speed * n).tolist()),
        ),
    }
    numerics = {"integrator": "midpoint", "speculative": True, "slop": 0.005}
    bench = balls(bodies, (0.0, 0.0, -G), **numerics)
    bench.run(steps)
    t = steps * DT
    # They still part at 5 mm/s, 2.5 mm from each other: closed within the slop, pressed by nothing.
    fall = np.array([0.0, 0.0, -0.5 * G * t**2])
    drawn = [n * force * t**2 / (2.0 * light), n * (speed * t - force * t**2 / (2.0 * heavy))]
    expected = [drawn[0] + fall, 2.0 * RADIUS * n + drawn[1] + fall]
    found = np.array([[bench.engine.bodies[axis][i] for axis in "xyz"] for i in (0, 1)])
    # Each step rounds places of 0.3 m, and velocities of 2 m/s whose errors all later steps keep.
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=steps * 2.3e-16)


def test_the_force_of_two_surfaces_is_their_geometric_mean() -> None:
    """1 N and 4 N draw with 2 N."""
    bodies = {
        "weak": sphere(RADIUS, (0.0, 0.0, 0.0), cohesion=1.0),
        "strong": sphere(RADIUS, (2.0 * RADIUS, 0.0, 0.0), cohesion=4.0, velocity=(1.0, 0.0, 0.0)),
    }
    bench = balls(bodies)
    bench.run(1)
    # One rounding near 1 m/s.
    np.testing.assert_allclose(bench.velocity[:, 0], [2.0 * DT, 1.0 - 2.0 * DT], atol=1.2e-16)


def test_the_pull_acts_at_the_contact_and_turns_what_it_pulls_off_centre() -> None:
    """A ball leaves a free box at r from its centre: I w = r x F dt z, m v = F dt z."""
    force, mass, wide, high = 3.0, 1.5, 0.4, 0.1
    x, y = 0.1, 0.2
    bodies = {
        "box": box((wide, wide, high), (0.0, 0.0, 0.0), mass=mass, cohesion=force),
        "ball": sphere(
            RADIUS, (x, y, 0.5 * high + RADIUS), cohesion=force, velocity=(0.0, 0.0, 1.0)
        ),
    }
    bench = interpreted_bench(resolved(bodies))
    bench.run(1)
    # The same about x and y, so that the turn of this step leaves the spin alone.
    inertia = mass * (wide**2 + high**2) / 12.0
    impulse = force * DT
    # One rounding of the box's 0.01 m/s, one of the ball's 1 m/s.
    np.testing.assert_allclose(bench.velocity[0], [0.0, 0.0, impulse / mass], atol=1e-17)
    np.testing.assert_allclose(bench.velocity[1], [0.0, 0.0, 1.0 - impulse], atol=1.2e-16)
    spin = [y * impulse / inertia, -x * impulse / inertia, 0.0]
    # 0.1 rad/s; ten roundings of the levers, the impulse and the turn.
    np.testing.assert_allclose(bench.spin[0], spin, atol=10 * 1.4e-17)


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
    assert "cohesion" not in planned(resolved(bodies, (0.0, 0.0, -G))).spec.effects


@pytest.mark.parametrize("spin", [0.0, 5.0], ids=["still", "turning"])
def test_balls_that_part_are_drawn_as_much_where_they_turn(spin: float) -> None:
    """What turns is solved again at the middle of the step (`contact_midpoint`): the pull stays."""
    force, light, heavy, speed = 3.0, 0.5, 2.0, 0.2
    common = {"cohesion": force, "friction": 0.5, "angular_velocity": (0.0, 0.0, spin)}
    bodies = {
        "light": sphere(RADIUS, (0.0, 0.0, 0.0), mass=light, **common),
        "heavy": sphere(
            RADIUS, (2.0 * RADIUS, 0.0, 0.0), mass=heavy, velocity=(speed, 0.0, 0.0), **common
        ),
    }
    bench = interpreted_bench(resolved(bodies, **DEFAULT.model_dump(mode="json")))
    rows = bench.run(1)
    np.testing.assert_array_equal(rows.contact["adhesive_impulse"], force * DT)
    gained, lost = force * DT / light, force * DT / heavy
    # Sums of a few terms of 0.2 m/s; friction presses nothing, and has no lever to turn by.
    expected = [[gained, 0.0, 0.0], [speed - lost, 0.0, 0.0]]
    np.testing.assert_allclose(bench.velocity, expected, atol=1e-16)
    np.testing.assert_allclose(bench.spin, [[0.0, 0.0, spin]] * 2, atol=1e-15)
    # They fly by the mean of old and new velocity, which counts the pull once; places of 0.2 m.
    way = [0.5 * gained * DT, 2.0 * RADIUS + (speed - 0.5 * lost) * DT]
    np.testing.assert_allclose(bench.engine.bodies["x"][:2], way, atol=1e-16)


@pytest.mark.parametrize("stiffness", [1e5, 1e7])
def test_a_ball_comes_off_at_the_force_of_its_adhesion_whatever_its_stiffness(
    stiffness: float,
) -> None:
    """Johnson, Kendall and Roberts: F = 3/2 pi w R; hung, d = ((F - m g)/k)^(2/3) by Hertz."""
    work = 50.0  # of adhesion [J/m^2]
    force = 1.5 * np.pi * work * RADIUS
    for share, holds in ((0.8, True), (0.999, True), (1.001, False)):
        mass, left = share * force / G, max((1.0 - share) * force, 0.0)
        depth = (left / stiffness) ** (2.0 / 3.0)
        bodies = {
            "ceiling": plane((0.0, 0.0, -1.0), -1.0, cohesion=force),
            "ball": sphere(
                RADIUS,
                (0.0, 0.0, 1.0 - RADIUS + depth),
                mass=mass,
                cohesion=force,
                hertz_stiffness=stiffness,
            ),
        }
        bench = balls(bodies, (0.0, 0.0, -G), **DEFAULT.model_dump(mode="json"))
        bench.run(60)
        found = bench.engine.bodies["z"][1] - 1.0 + RADIUS
        if holds:  # solves leave 1e-9 m/s a step
            assert found == pytest.approx(depth, abs=60 * DT * 1e-9)
        else:
            assert found < -0.2
