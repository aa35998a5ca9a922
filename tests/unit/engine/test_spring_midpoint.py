"""Springs at the middle of a step: energy and momenta by the discrete gradient, whatever the step.

    F = k ((l_0 + l_1)/2 - L) + c (l_1 - l_0)/dt
The spring's work is what it stores, k ((l_1 - L)^2 - (l_0 - L)^2)/2; the damper's is c (dl)^2/dt.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted_steps import Steps
from laboratory import box, resolved, sphere

from lavendersim.engine.spring_turn import TWISTED

STEP = 0.01
CENTRE = (0.0, 0.0, 0.0)


def tied(a: dict[str, Any], b: dict[str, Any], timestep: float = STEP, **spring: Any) -> Steps:
    """Return the engine of two bodies and a spring between points of theirs."""
    known = {"a": "a", "b": "b", "point_a": CENTRE, "point_b": CENTRE, "damping": 0.0}
    cell = resolved({"a": a, "b": b}, timestep=timestep, integrator="midpoint")
    cell["scene"]["springs"] = [{**known, **spring}]
    return Steps(cell)


def ball(place: Any, mass: float = 1.0, **properties: Any) -> dict[str, Any]:
    return sphere(0.05, place, mass=mass, **properties)


def lengths(steps: Steps, count: int) -> np.ndarray:
    """Return the distance of both centres before each of so many steps and at the end."""
    found = []
    for _ in range(count):
        found.append(np.linalg.norm(np.diff(steps.places, axis=0)))
        steps.run(1)
    return np.array([*found, np.linalg.norm(np.diff(steps.places, axis=0))])


def totals(row: np.ndarray) -> tuple[float, np.ndarray]:
    """Return energy and both momenta of a step."""
    names = ("momentum", "angular_momentum")
    momenta = [float(row[f"{name}_{axis}"]) for name in names for axis in "xyz"]
    return float(row["kinetic_energy"] + row["spring_energy"]), np.array(momenta)


def test_a_linear_spring_is_the_midpoint_rules(rng) -> None:
    """Two balls along a line: x_1 = x_0 + dt (v_0 + v_1)/2, and v by the mean stretch."""
    k, rest, m = 200.0, 0.5, (1.0, 3.0)
    for fixed in (False, True):
        a = ball(CENTRE, m[0], **({"fixed": True} if fixed else {}))
        b = ball((0.7, 0.0, 0.0), m[1], velocity=(-0.4, 0.0, 0.0))
        steps = tied(a, b, stiffness=k, rest_length=rest)
        inverse = (0.0 if fixed else 1.0 / m[0]) + 1.0 / m[1]
        stretch, rate = 0.2, -0.4
        for _ in range(10):
            steps.run(1)
            # The pair (s, v) of the rule, solved by hand.
            q = 0.25 * k * inverse * STEP**2
            after = (rate * (1.0 - q) - k * inverse * STEP * stretch) / (1.0 + q)
            stretch, rate = stretch + 0.5 * STEP * (rate + after), after
            found = float(np.diff(steps.places[:, 0])[0]) - rest
            assert found == pytest.approx(stretch, abs=1e-13)
            assert float(np.diff(steps.velocities[:, 0])[0]) == pytest.approx(rate, abs=1e-12)


@pytest.mark.parametrize("stiffness", [10.0, 1e4])
def test_energy_and_momenta_stay_however_far_it_turns(stiffness: float, rng) -> None:
    """In steps in which it turns by a fifth of a radian; and of bodies with a spin, off centre."""
    for boxes in (None, (0.2, 0.2, 0.2), (0.2, 0.3, 0.1)):
        start = {"velocity": tuple(random_frame(rng)[0] * 8.0)}
        if boxes:
            start["angular_velocity"] = tuple(rng.normal(size=3) * 3.0)
            a, b = (box(boxes, p, **start) for p in ((0, 0, 0), (0.5, 0.2, 0.1)))
            b["velocity"] = [-1.0, 2.0, 0.5]
            points = {"point_a": (0.05, 0.1, -0.02), "point_b": (-0.08, 0.03, 0.04)}
        else:
            a, b, points = ball(CENTRE, 2.0), ball((0.5, 0.2, 0.1), **start), {}
        step = STEP if stiffness < 100.0 else 0.1 * STEP
        steps = tied(a, b, step, stiffness=stiffness, rest_length=0.3, **points)
        energy, momenta = totals(steps.run(1)[0])
        for _ in range(20):
            row = steps.run(1)[0]
            assert row["spring_not_converged"] == 0
            now, moved = totals(row)
            # Impulses are found to 1e-14 of the largest; twenty steps of some dozen roundings.
            assert now == pytest.approx(energy, rel=1e-11)
            np.testing.assert_allclose(moved, momenta, atol=1e-11 * stiffness)
        if boxes:
            assert (steps.engine.bodies["sprung"] == TWISTED).all()


def test_a_damper_takes_its_work_and_no_more(rng) -> None:
    """Resolved by the step: c (dl)^2/dt in each, of a spring that turns as well."""
    c, k = 0.7, 50.0
    steps = tied(
        ball(CENTRE, 2.0), ball((0.4, 0.0, 0.0), velocity=(0.5, 2.0, 0.0)),
        stiffness=k, damping=c, rest_length=0.3,
    )  # fmt: skip
    energy, _ = totals(steps.run(1)[0])
    for _ in range(15):
        before = np.linalg.norm(np.diff(steps.places, axis=0))
        now, _ = totals(steps.run(1)[0])
        longer = np.linalg.norm(np.diff(steps.places, axis=0)) - before
        assert now - energy == pytest.approx(-c * longer**2 / STEP, abs=1e-12)
        energy = now
    # Of kinetic energy v^2/2 and k (0.1 m)^2/2 it takes c v^2 dt, of 0.5 m/s along it, a step.
    assert energy < 2.375 - 0.3 * 15.0 * c * 0.25 * STEP


def damped(k: float, c: float, beta: float, state: np.ndarray) -> np.ndarray:
    """Return stretch and rate after a step of two balls of 1 kg: both linear equations at once.

    v_1 = v_0 - K dt F, s_1 = s_0 + dt (v_0 + v_1)/2, and F of the docstrings, beta's damper too.
    """
    s, v = state
    response, dt = 2.0 * STEP, STEP
    rates = response * (0.5 * k + c / dt), 1.0 + 0.75 * response * beta * k * dt
    force = (0.5 * k - c / dt) * s + 0.25 * beta * k * dt * v
    left = np.array([[1.0, -0.5 * dt], rates])
    right = [s + 0.5 * dt * v, v - response * force]
    return np.linalg.solve(left, right)


@pytest.mark.parametrize("stiffness", [1e4, 3e4, 1e7, 1e9])
@pytest.mark.parametrize("damping", [20.0, 200.0, 1000.0])
def test_what_steps_do_not_resolve_has_more_of_a_damper(stiffness: float, damping: float) -> None:
    """beta = min(1, c K dt/4) where k K dt^2 > 4; at 1 no stretch is left after two, whatever k."""
    steps = tied(
        ball(CENTRE), ball((0.6, 0.0, 0.0)), stiffness=stiffness, damping=damping, rest_length=0.5
    )
    beta = min(1.0, 0.25 * damping * 2.0 * STEP) if stiffness * 2.0 * STEP**2 > 4.0 else 0.0
    found, state = lengths(steps, 4) - 0.5, np.array([0.1, 0.0])
    for stretch in found:
        # Digits of places of 1 m, which the spring has for its force: 1e-16 k K dt^2 of a rate.
        assert stretch == pytest.approx(state[0], abs=1e-12)
        state = damped(stiffness, damping, beta, state)
    if beta == 1.0:
        assert abs(found[2:]).max() < 1.0 / (stiffness * STEP**2) + 1e-3 * damping / 1000.0


def test_without_a_damper_it_rings_for_ever() -> None:
    """v_1 = -v_0, undamped: the stretch changes its sign and keeps its size, and so energy."""
    steps = tied(ball(CENTRE), ball((0.6, 0.0, 0.0)), stiffness=1e7, rest_length=0.5)
    found = lengths(steps, 4) - 0.5
    q = 0.25 * 1e7 * 2.0 * STEP**2  # of the rule: s_1 = s_0 (1 - q)/(1 + q) from rest
    assert found[1] == pytest.approx(0.1 * (1.0 - q) / (1.0 + q), rel=1e-9)
    assert abs(found).max() <= 0.1 * (1.0 + 1e-9)


def test_far_from_the_origin_it_is_found_to_digits_of_places() -> None:
    """At 1 km lengths have 1e-13 m, which a stiff spring makes a force of: that is no failure."""
    far = np.array((1000.0, -700.0, 300.0))
    for stiffness in (1e4, 1e6, 1e8):
        for damping in (0.0, 0.01 * stiffness):
            steps = tied(
                *(ball(tuple(far + p)) for p in np.array([CENTRE, (0.5, 0.2, 0.1)])),
                stiffness=stiffness, damping=damping, rest_length=0.5,
            )  # fmt: skip
            steps.run(4)
            assert steps.counters.spring_not_converged == 0


def test_a_spring_without_length_or_force_gives_nothing() -> None:
    for place, rest in ((CENTRE, 0.0), ((0.5, 0.0, 0.0), 0.5)):
        steps = tied(ball(CENTRE), ball(place), stiffness=100.0, rest_length=rest)
        steps.run(3)
        assert not steps.velocities.any()
        assert steps.counters.spring_not_converged == 0


def test_a_spring_that_is_cut_does_not_act() -> None:
    steps = tied(ball(CENTRE), ball((0.7, 0.0, 0.0)), stiffness=100.0, rest_length=0.5)
    steps.engine.state.links["active"] = 0
    steps.run(2)
    assert not steps.velocities.any()


def test_ends_and_frames_may_be_exchanged(rng) -> None:
    """Mirrored, turned, and with A and B exchanged it does the same."""
    places, v = np.array([CENTRE, (0.5, 0.2, 0.1)]), rng.normal(size=(2, 3))
    spring = {"stiffness": 300.0, "damping": 1.0, "rest_length": 0.3}
    first = tied(*(ball(p, velocity=tuple(u)) for p, u in zip(places, v, strict=True)), **spring)
    first.run(5)
    for sign in (1.0, -1.0):
        turned = sign * random_frame(rng)
        moved = zip(places @ turned.T, v @ turned.T, strict=True)
        bodies = [ball(tuple(p), velocity=tuple(u)) for p, u in moved]
        for order in (1, -1):
            other = tied(*bodies[::order], **spring)
            other.run(5)
            np.testing.assert_allclose(other.places[::order], first.places @ turned.T, atol=1e-13)


def test_springs_share_a_body() -> None:
    """Of three in a star all are found together: its momentum is that of their mean forces."""
    bodies = {"hub": ball(CENTRE)}
    springs = []
    for k in range(3):
        angle = 2.0 * np.pi * k / 3.0
        place = (float(np.cos(angle)), float(np.sin(angle)), 0.0)
        bodies[f"end {k}"] = ball(place, fixed=True)
        springs.append(
            {"a": "hub", "b": f"end {k}", "point_a": CENTRE, "point_b": CENTRE, "damping": 0.0}
            | {"stiffness": 400.0, "rest_length": 0.4}
        )
    bodies["hub"]["velocity"] = [0.3, 0.1, 0.0]
    cell = resolved(bodies, timestep=STEP, integrator="midpoint")
    cell["scene"]["springs"] = springs
    steps = Steps(cell)
    energy, _ = totals(steps.run(1)[0])
    for _ in range(20):
        row = steps.run(1)[0]
        assert totals(row)[0] == pytest.approx(energy, rel=1e-12)
        assert row["spring_not_converged"] == 0


def test_impulses_that_are_not_found_are_counted_and_bodies_are_placed() -> None:
    """Stiff, far stretched and off centre: turned by radians in a step there may be none."""
    a = box((0.02, 0.05, 0.09), (0.0, 0.1, 0.0), mass=0.3, angular_velocity=(1.0, 2.0, 3.0))
    b = box((0.1, 0.04, 0.2), (3.0, 0.0, 0.3), mass=2.0, angular_velocity=(-1.0, 0.5, 2.0))
    points = {"point_a": (0.05, 0.08, 0.02), "point_b": (-0.1, 0.06, 0.1)}
    steps = tied(a, b, 1.0 / 60.0, stiffness=1e7, rest_length=0.5, **points)
    energy, momenta = None, None
    lost = 0
    for _ in range(4):
        row = steps.run(1)[0]
        lost += int(row["spring_not_converged"])
        now, moved = totals(row)
        if energy is not None:
            assert now <= energy * (1.0 + 1e-12)
            np.testing.assert_allclose(moved, momenta, atol=1e-10)
        energy, momenta = now, moved
    assert lost > 0
