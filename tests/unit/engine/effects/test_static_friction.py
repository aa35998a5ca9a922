"""Static friction: a block holds up to atan(mu_s), and slides by mu(v) once it moves.

    v' = v + dt g (sin - mu(v) cos),   mu(v) = mu_k + (mu_s - mu_k) / (1 + (v / v_s)^2)
v the speed that the step begins with: the closed form is that recursion itself.
"""

from __future__ import annotations

from math import atan, cos, log1p, sin

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, planned, resolved, sphere

G, DT = 9.81, 1.0 / 240.0
KINETIC, STATIC, STRIBECK = 0.3, 0.6, 0.05
CURVE = {"friction": KINETIC, "static_friction": STATIC, "stribeck_velocity": STRIBECK}
SHARP = {"solver": "adaptive", "sweeps": 400, "tolerance": 1e-13}
# Sweeps stop at 1e-13 m/s; what they leave may stay in the speed of all later steps.
LEFT = 1e-13


def bench_of(bodies: dict, gravity: tuple, **numerics) -> Bench:
    """Boxes, of which one engine serves all: drag and belts that a scene has not are idle."""
    cell = resolved(bodies, gravity, **SHARP, **numerics)
    return Bench(cell, planned(cell).spec.including("drag", "surface_velocity"))


def mu(v: float) -> float:
    return KINETIC + (STATIC - KINETIC) / (1.0 + (v / STRIBECK) ** 2)


def block(tangent: float, speed: float = 0.0, **properties) -> Bench:
    """A flat block of 1 kg on a floor under gravity that leans by a tangent."""
    surface = {
        "friction": KINETIC,
        "static_friction": STATIC,
        "stribeck_velocity": STRIBECK,
    }
    belt = properties.pop("belt", 0.0)
    bodies = {
        "floor": plane(surface_velocity=(belt, 0.0, 0.0), **surface),
        "block": box(
            (0.4, 0.4, 0.05),
            (0.0, 0.0, 0.025),
            velocity=(speed, 0.0, 0.0),
            **surface,
            **properties,
        ),
    }
    lean = atan(tangent)
    return bench_of(bodies, (G * sin(lean), 0.0, -G * cos(lean)))


def speeds(bench: Bench, steps: int) -> np.ndarray:
    found = []
    for _ in range(steps):
        bench.run(1)
        found.append(bench.velocity[1, 0])
    return np.array(found)


def recursion(tangent: float, speed: float, steps: int) -> np.ndarray:
    lean, found = atan(tangent), []
    for _ in range(steps):
        speed = speed + DT * G * (sin(lean) - mu(speed) * cos(lean))
        found.append(speed)
    return np.array(found)


def test_a_block_at_rest_holds_up_to_the_static_angle() -> None:
    found = speeds(block(STATIC * 0.999), 120)
    np.testing.assert_allclose(found, 0.0, atol=120 * LEFT)


def test_a_block_slides_beyond_the_static_angle() -> None:
    tangent = STATIC * 1.01
    found = speeds(block(tangent), 120)
    np.testing.assert_allclose(found, recursion(tangent, 0.0, 120), atol=1e-9)
    assert found[-1] > 10.0 * STRIBECK


def test_one_slope_holds_what_rests_and_speeds_up_what_slides() -> None:
    """Between atan(mu_k) and atan(mu_s) both are lasting."""
    tangent = 0.5 * (KINETIC + STATIC)
    np.testing.assert_allclose(speeds(block(tangent), 60), 0.0, atol=60 * LEFT)
    sliding = speeds(block(tangent, 1.0), 60)
    np.testing.assert_allclose(sliding, recursion(tangent, 1.0, 60), rtol=1e-10)
    # Fast, it slides as kinetic friction alone would let it: at 1 m/s and above mu differs by
    # at most 0.3 / (1 + 20^2) = 7.5e-4, a two hundredth of tan - mu_k = 0.15.
    a = G * (sin(atan(tangent)) - KINETIC * cos(atan(tangent)))
    assert sliding[-1] - sliding[0] == pytest.approx(59 * DT * a, rel=5e-3)


def test_the_coefficient_of_the_slip_is_logged() -> None:
    rows = block(0.45, 1.0).run(2).contact
    np.testing.assert_allclose(rows["friction"][rows["step"] == 1], mu(1.0), rtol=1e-14)


def test_two_surfaces_mix_as_kinetic_friction_does_and_take_the_larger_speed() -> None:
    """sqrt(0.2 * 0.45) = 0.3, sqrt(0.4 * 0.9) = 0.6, and 0.05 m/s is above 0.02 m/s."""
    one = {"friction": 0.2, "static_friction": 0.4, "stribeck_velocity": 0.02}
    other = {"friction": 0.45, "static_friction": 0.9, "stribeck_velocity": STRIBECK}
    speed = 2.0 * STRIBECK
    bodies = {
        "floor": plane(**one),
        "block": box((0.4, 0.4, 0.05), (0.0, 0.0, 0.025), velocity=(speed, 0.0, 0.0), **other),
    }
    rows = bench_of(bodies, (0.0, 0.0, -G)).run(1).contact
    # A dozen roundings of products and roots.
    np.testing.assert_allclose(rows["friction"], mu(speed), rtol=12 * 1.1e-16)


def test_the_slip_is_that_of_the_two_surfaces_where_they_touch() -> None:
    """|t (v_B + w_B x r_B + s_B - v_A - w_A x r_A - s_A)|, of bodies that move and turn."""
    radius, high = 0.1, 0.1
    surface = {"friction": KINETIC, "static_friction": STATIC, "stribeck_velocity": 1.0}
    place = np.array([0.12, -0.07, 0.5 * high + radius])
    moves = {
        "box": ((0.4, -0.3, 0.0), (0.5, -0.8, 2.0), (0.3, -0.2, 0.0)),
        "ball": ((-0.2, 0.6, 0.0), (3.0, 4.0, -5.0), (0.0, 0.0, 0.0)),
    }
    given = {
        name: {"velocity": v, "angular_velocity": w, "surface_velocity": s, **surface}
        for name, (v, w, s) in moves.items()
    }
    bodies = {
        "box": box((0.4, 0.4, high), (0.0, 0.0, 0.0), **given["box"]),
        "ball": sphere(radius, tuple(place.tolist()), **given["ball"]),
    }
    rows = interpreted_bench(resolved(bodies)).run(1).contact
    levers = {"box": place - [0.0, 0.0, radius], "ball": np.array([0.0, 0.0, -radius])}
    at = {
        name: np.array(v) + np.cross(w, levers[name]) + np.array(s)
        for name, (v, w, s) in moves.items()
    }
    slip = (at["ball"] - at["box"])[:2]
    expected = KINETIC + (STATIC - KINETIC) / (1.0 + float(slip @ slip))
    assert 0.5 < float(slip @ slip) < 5.0
    # Thirty roundings of terms of the slip's size.
    np.testing.assert_allclose(rows["friction"], expected, rtol=30 * 1.1e-16)


def test_a_belt_carries_a_block_to_where_drag_balances_the_friction_of_its_slip() -> None:
    """c v = mu(V - v) m g once nothing changes; there the slip is several times v_s."""
    belt, drag = 1.0, 5.0
    bench = block(0.0, belt=belt, drag={"linear": drag})
    v = float(speeds(bench, 1200)[-1])
    assert belt - v > 5.0 * STRIBECK
    assert drag * v == pytest.approx(mu(belt - v) * G, rel=1e-9)


def test_where_nothing_is_held_more_at_rest_the_effect_is_absent() -> None:
    bodies = {
        "floor": plane(friction=0.5, static_friction=0.4),
        "block": box((0.4, 0.4, 0.05), (0.0, 0.0, 0.025), friction=0.5, static_friction=0.4),
    }
    assert "static_friction" not in planned(resolved(bodies, (0.0, 0.0, -G))).spec.effects


def way(v: float) -> float:
    """The way [m] to a stop on a level floor: the integral of v dv / (g mu(v)), worked out."""
    ratio = KINETIC * v * v / (STATIC * STRIBECK**2)
    return (v * v - STRIBECK**2 * (STATIC / KINETIC - 1.0) * log1p(ratio)) / (2.0 * G * KINETIC)


def test_the_way_to_a_stop_is_its_integral() -> None:
    """Simpson's rule over 2000 panels: its error is below 1e-12 of an integrand this smooth."""
    v = np.linspace(0.0, 10.0 * STRIBECK, 4001)
    f = v / (G * np.array([mu(one) for one in v]))
    simpson = (
        (v[1] - v[0]) / 3.0 * float(f[0] + f[-1] + 4.0 * f[1::2].sum() + 2.0 * f[2:-1:2].sum())
    )
    assert way(10.0 * STRIBECK) == pytest.approx(simpson, rel=1e-11)


def stopping_way(rate: int, speed: float) -> float:
    bodies = {
        "floor": plane(**CURVE),
        "block": box(
            (0.4, 0.4, 0.05), (0.0, 0.0, 0.025), velocity=(speed, 0.0, 0.0), mass=2.0, **CURVE
        ),
    }
    bench = bench_of(bodies, (0.0, 0.0, -G), timestep=f"1/{rate}")
    bench.run(int(2.0 * speed / (G * KINETIC) * rate))
    assert abs(bench.velocity[1, 0]) < 1e-9
    # Poses move by new velocities, v dt / 2 less in all than by the mean of old and new.
    return float(bench.engine.bodies["x"][1]) + 0.5 * speed / rate


def test_a_block_stops_after_the_way_of_its_curve_to_first_order_in_the_timestep() -> None:
    """The coefficient is that of the slip as a step begins: each halving halves what it misses.

    By the mean of old and new velocities, whose error is of second order, as that of the step in
    which the block stops is, all that is left is the coefficient's.
    """
    speed = 10.0 * STRIBECK
    missed = [stopping_way(rate, speed) - way(speed) for rate in (480, 960, 1920, 3840)]
    orders = np.log2(np.array(missed[:-1]) / np.array(missed[1:]))
    assert min(missed) > 0.0  # late, so too little of a coefficient that grows
    np.testing.assert_allclose(orders, 1.0, atol=0.1)
    assert missed[-1] < 2e-3 * way(speed)
