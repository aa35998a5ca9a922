"""Springs: the discrete motions of one and two masses, in closed form.

    q = (x, v),  q' = M q,   M = [[0, 1], [-k/m, -c/m]]
    midpoint rule    q <- (1 - h M / 2)^-1 (1 + h M / 2) q: Cayley's map. Undamped it turns the
                     phase by 2 atan(omega h / 2), so that x_n = x_0 cos(n 2 atan(omega h / 2))
    implicit Euler   q <- (1 - h M)^-1 q
Two free masses move as one of m_A m_B / (m_A + m_B) about their centre of mass.
"""

from __future__ import annotations

from math import atan, cos
from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, planned, resolved, sphere

DT = 1.0 / 240.0
K, M, REST, STRETCH = 50.0, 2.0, 0.5, 0.2
STEPS = 200


def joined(bodies: dict[str, Any], gravity=(0.0, 0.0, 0.0), integrator="midpoint", **spring) -> Any:
    """A spring between the two bodies of a scene."""
    cell = resolved(bodies, gravity, integrator=integrator)
    a, b = bodies
    specified = {"a": a, "b": b, "stiffness": K, "rest_length": REST, **spring}
    cell["scene"]["springs"] = [specified]
    return cell


def bench_of(cell: dict[str, Any]) -> Bench:
    """Masses on springs, of which one engine of each integrator serves all."""
    spec = planned(cell).spec.including("gravity")
    return Bench(cell, spec._replace(shape_pairs=("sphere_sphere",)))


def on_a_hook(**spring) -> Bench:
    """A mass on a spring whose other end stays, stretched along x."""
    bodies = {
        "hook": sphere(0.01, (0.0, 0.0, 0.0), fixed=True),
        "mass": sphere(0.05, (REST + STRETCH, 0.0, 0.0), mass=M),
    }
    return bench_of(joined(bodies, **spring))


def stretches(bench: Bench, steps: int) -> np.ndarray:
    found = []
    for _ in range(steps):
        bench.run(1)
        found.append(bench.engine.bodies["x"][1] - bench.engine.bodies["x"][0] - REST)
    return np.array(found)


def powers(step: np.ndarray, steps: int) -> np.ndarray:
    """x of q_n = step^n (STRETCH, 0)."""
    q, found = np.array([STRETCH, 0.0]), []
    for _ in range(steps):
        q = step @ q
        found.append(q[0])
    return np.array(found)


def matrix(k: float, c: float, m: float) -> np.ndarray:
    return np.array([[0.0, 1.0], [-k / m, -c / m]])


# A step rounds x near 1 m a few times; 200 of them may add up: 200 * 4 * 1.1e-16.
ROUND_OFF = 1e-13


def test_an_undamped_mass_swings_with_the_period_of_the_midpoint_rule() -> None:
    found = stretches(on_a_hook(), STEPS)
    turn = 2.0 * atan(0.5 * DT * np.sqrt(K / M))
    expected = [STRETCH * cos(n * turn) for n in range(1, STEPS + 1)]
    assert STEPS * turn > np.pi  # more than a half swing
    np.testing.assert_allclose(found, expected, atol=ROUND_OFF)


@pytest.mark.parametrize("damping", [0.0, 1.5])
def test_a_mass_follows_the_rule_of_its_integrator(damping: float) -> None:
    step, one = matrix(K, damping, M), np.eye(2)
    cayley = np.linalg.solve(one - 0.5 * DT * step, one + 0.5 * DT * step)
    found = stretches(on_a_hook(damping=damping), STEPS)
    np.testing.assert_allclose(found, powers(cayley, STEPS), atol=ROUND_OFF)
    euler = np.linalg.inv(one - DT * step)
    found = stretches(on_a_hook(damping=damping, integrator="semi_implicit_euler"), STEPS)
    np.testing.assert_allclose(found, powers(euler, STEPS), atol=ROUND_OFF)


@pytest.mark.parametrize("integrator", ["midpoint", "semi_implicit_euler"])
def test_a_spring_of_any_stiffness_is_stable(integrator: str) -> None:
    """omega dt is 93: an explicit step would grow by thousands."""
    found = stretches(on_a_hook(stiffness=1e9, integrator=integrator), STEPS)
    assert np.abs(found).max() <= STRETCH * (1.0 + 1e-9)


def two(**spring) -> Bench:
    bodies = {
        "light": sphere(0.05, (0.0, 0.0, 0.0), mass=1.0),
        "heavy": sphere(0.05, (REST + STRETCH, 0.0, 0.0), mass=3.0),
    }
    return bench_of(joined(bodies, **spring))


def test_two_masses_swing_as_their_reduced_mass_and_keep_their_momentum() -> None:
    bench = two(damping=0.8)
    step, one = matrix(K, 0.8, 0.75), np.eye(2)
    cayley = np.linalg.solve(one - 0.5 * DT * step, one + 0.5 * DT * step)
    found = stretches(bench, STEPS)
    np.testing.assert_allclose(found, powers(cayley, STEPS), atol=ROUND_OFF)
    np.testing.assert_allclose(1.0 * bench.velocity[0] + 3.0 * bench.velocity[1], 0.0, atol=1e-14)


def test_what_a_spring_stores_it_gives_back() -> None:
    rows = two().run(STEPS).step
    total = rows["kinetic_energy"] + rows["spring_energy"]
    start = 0.5 * K * STRETCH**2
    np.testing.assert_allclose(total, start, rtol=1e-12)
    assert rows["spring_energy"].min() < 0.01 * start  # it has given all of it, in between
    np.testing.assert_array_equal(rows["spring_impulse_x"], 0.0)  # both move


def test_the_impulse_from_a_hook_is_what_the_mass_gains() -> None:
    rows = on_a_hook().run(STEPS).step
    gained = np.diff(rows["momentum_x"])
    np.testing.assert_allclose(rows["spring_impulse_x"][1:], gained, atol=1e-15)
    np.testing.assert_allclose(rows["spring_force"][1:] * -DT, gained, atol=1e-15)


@pytest.mark.parametrize("names", [("hook", "mass"), ("mass", "hook")])
def test_the_impulse_from_a_hook_is_logged_along_each_axis(names: tuple[str, str]) -> None:
    """Of whichever of the two bodies the spring names first, it is the mass that gains it."""
    bodies = {
        "hook": sphere(0.01, (0.0, 0.0, 0.0), fixed=True),
        "mass": sphere(0.05, (0.3, -0.5, 0.4), mass=M, velocity=(0.2, 0.1, -0.3)),
    }
    rows = bench_of(joined({name: bodies[name] for name in names})).run(STEPS).step
    for axis in "xyz":
        gained = np.diff(rows[f"momentum_{axis}"])
        assert np.abs(gained).max() > 0.01
        # The momentum is below 2 kg m/s, and its velocity is rounded once a step.
        np.testing.assert_allclose(rows[f"spring_impulse_{axis}"][1:], gained, atol=1e-15)


def test_off_centre_the_force_is_that_of_the_velocities_it_leads_to() -> None:
    """F = k (l - l_0) + (k dt + c) u, u the rate at the points with v', by the implicit Euler rule.

    The law that the formula of the impulse solves, spins and levers included.
    """
    damping, masses, radii = 0.3, (1.0, 3.0), (0.2, 0.3)
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.3, 0.2]])
    before = np.array([[0.1, -0.2, 0.3], [0.0, 0.4, -0.1]])
    spins = np.array([[1.0, -2.0, 0.5], [-0.7, 0.4, 1.5]])
    points = np.array([[0.1, 0.15, 0.0], [0.0, -0.2, 0.1]])
    bodies = {
        name: sphere(
            radii[i],
            tuple(places[i].tolist()),
            mass=masses[i],
            velocity=tuple(before[i].tolist()),
            angular_velocity=tuple(spins[i].tolist()),
        )
        for i, name in enumerate(("one", "other"))
    }
    ends = {"point_a": tuple(points[0].tolist()), "point_b": tuple(points[1].tolist())}
    bench = interpreted_bench(
        joined(bodies, integrator="semi_implicit_euler", damping=damping, **ends)
    )
    force = float(bench.run(1).step["spring_force"][-1])
    between = places[1] + points[1] - places[0] - points[0]
    length = float(np.sqrt(between @ between))
    d = between / length

    def rate(v: np.ndarray, spin: np.ndarray) -> float:
        at = v + np.cross(spin, points)
        return float(d @ (at[1] - at[0]))

    u = rate(bench.velocity, bench.spin)
    # 40 N in some thirty roundings; so are the changes of velocity, 0.2 m/s, and of spin.
    law = K * (length - REST) + (K * DT + damping) * u
    assert force == pytest.approx(law, rel=30 * 1.1e-16)
    for i, sign in enumerate((1.0, -1.0)):
        impulse = sign * DT * force * d
        inertia = 0.4 * masses[i] * radii[i] ** 2
        np.testing.assert_allclose(bench.velocity[i], before[i] + impulse / masses[i], atol=1e-15)
        turned = spins[i] + np.cross(points[i], impulse) / inertia
        np.testing.assert_allclose(bench.spin[i], turned, atol=30 * 2.3e-16)


def test_a_hanging_mass_comes_to_rest_where_the_spring_carries_it() -> None:
    bodies = {
        "hook": sphere(0.01, (0.0, 0.0, 0.0), fixed=True),
        "mass": sphere(0.05, (0.0, 0.0, -REST), mass=M),
    }
    # Critically damped: 2 sqrt(k m) = 20 N s/m; after 8 s, 40 decay times, e^-40 is left.
    bench = bench_of(joined(bodies, (0.0, 0.0, -9.81), damping=20.0))
    rows = bench.run(1920).step
    assert rows["spring_stretch"][-1] == pytest.approx(M * 9.81 / K, rel=1e-12)
    assert rows["spring_force"][-1] == pytest.approx(M * 9.81, rel=1e-12)


def test_off_their_centres_springs_turn_bodies_and_keep_angular_momentum() -> None:
    bodies = {
        "one": sphere(0.2, (0.0, 0.0, 0.0), mass=1.0),
        "other": sphere(0.3, (1.0, 0.3, 0.2), mass=3.0, velocity=(0.0, 0.4, -0.1)),
    }
    # Euler's rule: bodies move along the velocity that they end the step with, so that places times
    # momenta stay; the midpoint rule trades this for the energy.
    ends = {"point_a": (0.1, 0.15, 0.0), "point_b": (0.0, -0.2, 0.1)}
    cell = joined(bodies, integrator="semi_implicit_euler", damping=0.3, **ends)
    bench = interpreted_bench(cell)
    rows = bench.run(STEPS).step
    assert np.abs(bench.spin).max() > 0.1
    for axis in "xyz":
        momentum = rows[f"angular_momentum_{axis}"]
        # Of 1 kg m^2/s; a step rounds it a dozen times.
        np.testing.assert_allclose(momentum, momentum[0], atol=STEPS * 12 * 2.3e-16)


def test_without_springs_or_with_fixed_ends_the_effect_is_absent() -> None:
    bodies = {
        "one": sphere(0.1, (0.0, 0.0, 0.0), fixed=True),
        "other": sphere(0.1, (1.0, 0.0, 0.0), fixed=True),
    }
    assert "spring" not in planned(joined(bodies)).spec.effects
    assert "spring" not in planned(resolved(bodies)).spec.effects
