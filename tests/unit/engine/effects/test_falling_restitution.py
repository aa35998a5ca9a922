"""Restitution that falls with the approach speed: e(v) = e_0 (v_y / v)^(1/4) above v_y.

Bounces on a floor have a closed form: with v* = e_0^4 v_y a rebound is v* (v / v*)^(3/4), so after
k of them, all faster than v_y, v_k = v* (v_0 / v*)^((3/4)^k).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, box, plane, planned, resolved, sphere

from lavendersim.engine.spec import Spec

G = 9.81
E_0, YIELDS = 0.8, 0.5  # [-], [m/s]
FALLING = {"restitution": E_0, "yield_speed": YIELDS}
RADIUS = 0.1
IMPACTS = ("captured", "at_surface", "in_order")
# A rounding of each of a dozen operations.
ROUND_OFF = 12 * 1.1e-16


def law(speed: float, e: float = E_0, yields: float = YIELDS) -> float:
    """The law as its definition has it: a power, not two roots."""
    return e * (yields / max(speed, yields)) ** 0.25


def rigid(bodies: dict[str, Any], impacts: str) -> Bench:
    """Balls without gravity, for a step or a few."""
    cell = resolved(bodies, impacts=impacts)
    return interpreted_bench(cell, planned(cell).spec)


def thrown(speed: float, impacts: str, **surface: float) -> Bench:
    """A ball that touches a floor and approaches it, without gravity."""
    bodies = {
        "floor": plane(**surface),
        "ball": sphere(RADIUS, (0.0, 0.0, RADIUS), velocity=(0.0, 0.0, -speed), **surface),
    }
    return rigid(bodies, impacts)


@pytest.mark.parametrize("impacts", IMPACTS)
@pytest.mark.parametrize("speed", [0.1, 0.5, 0.51, 8.0, 40.5])
def test_a_rebound_has_the_restitution_of_its_approach_speed(speed: float, impacts: str) -> None:
    """0.1 and 0.5 m/s do not yield; 8 and 40.5 m/s are 16 and 81 times as fast: e_0/2, e_0/3."""
    bench = thrown(speed, impacts, **FALLING)
    contact = bench.run(1).contact
    assert bench.velocity[1, 2] == pytest.approx(law(speed) * speed, rel=ROUND_OFF)
    exact = {0.1: E_0, 0.5: E_0, 8.0: E_0 / 2.0, 40.5: E_0 / 3.0}
    if speed in exact:
        assert bench.velocity[1, 2] == pytest.approx(exact[speed] * speed, rel=ROUND_OFF)
    assert contact["restitution"].max() == pytest.approx(law(speed), rel=ROUND_OFF)


@pytest.mark.parametrize("impacts", ["captured", "in_order"])
def test_two_bodies_have_that_of_the_speed_between_them(impacts: str) -> None:
    """Momentum stays, and they part with e(v) v of their approach: 2 + 6 = 8 m/s."""
    bodies = {
        "a": sphere(RADIUS, (-RADIUS, 0.0, 0.0), velocity=(2.0, 0.0, 0.0), mass=3.0, **FALLING),
        "b": sphere(RADIUS, (RADIUS, 0.0, 0.0), velocity=(-6.0, 0.0, 0.0), mass=1.0, **FALLING),
    }
    bench = rigid(bodies, impacts)
    bench.run(1)
    a, b = bench.velocity[:, 0]
    assert b - a == pytest.approx(E_0 / 2.0 * 8.0, rel=ROUND_OFF)
    assert 3.0 * a + b == pytest.approx(0.0, abs=8.0 * ROUND_OFF)


def bounces(rate: int, impacts: str) -> tuple[np.ndarray, np.ndarray]:
    """The speeds of a ball dropped from 1 m and of its rebounds, and those of the closed form."""
    floor, ball = plane(**FALLING), sphere(RADIUS, (0.0, 0.0, 1.0 + RADIUS), **FALLING)
    ahead = impacts == "in_order"  # contacts are looked for before bodies touch
    numerics = {"impacts": impacts, "timestep": f"1/{rate}", "integrator": "midpoint"}
    numerics["speculative"] = ahead
    bench = Bench(resolved({"floor": floor, "ball": ball}, (0.0, 0.0, -G), **numerics), None)
    found = [np.sqrt(2.0 * G)]
    for _ in range(int(1.4 * rate)):
        bench.run(1)
        v, z = bench.velocity[1, 2], float(bench.engine.bodies["z"][1]) - RADIUS
        # The midpoint rule keeps energy in flight: a bounce is what takes some.
        speed = np.sqrt(max(v * v + 2.0 * G * z, 0.0))
        if v > 0.0 and speed < 0.9 * found[-1]:
            found.append(speed)
    limit = E_0**4 * YIELDS
    return np.array(found), limit * (found[0] / limit) ** (0.75 ** np.arange(len(found)))


@pytest.mark.parametrize("rate", [60, 240])
def test_bounces_of_a_drop_are_those_of_the_closed_form_at_any_timestep(rate: int) -> None:
    found, form = (speeds[:4] for speeds in bounces(rate, "in_order"))
    assert form[2] > YIELDS  # the slowest approach: all are by the power
    # Impacts in order are at their time and speed: round-off of some hundred steps.
    np.testing.assert_allclose(found, form, rtol=1e-12)


def test_captured_the_law_is_of_first_order_in_the_timestep() -> None:
    """Its approach speed is that of the step that finds the contact, late by up to dt.

    That is g dt in the speed v, of which the rebound w takes 3/4 of the share; and the ball is up
    to v dt below the floor as it turns, which is g v dt of its energy. Half of dt, half of both.
    """
    for rate in (240, 480, 960, 1920):
        found, form = bounces(rate, "captured")
        v, w = form[:2]
        assert abs(found[1] / w - 1.0) < G / rate * (0.75 / v + v / w**2)


def test_a_pair_takes_the_smaller_speed_above_0_and_the_larger_restitution() -> None:
    hard, soft = {"restitution": E_0}, {"restitution": 0.3, "yield_speed": 2.0}
    for floor, ball, yields in (
        (hard, soft, 2.0),
        (soft, hard, 2.0),
        (FALLING, soft, YIELDS),
        (soft, FALLING, YIELDS),
    ):
        bodies = {
            "floor": plane(**floor),
            "ball": sphere(RADIUS, (0.0, 0.0, RADIUS), velocity=(0.0, 0.0, -8.0), **ball),
        }
        bench = rigid(bodies, "in_order")
        bench.run(1)
        expected = law(8.0, yields=yields) * 8.0
        assert bench.velocity[1, 2] == pytest.approx(expected, rel=ROUND_OFF)


def tilted(spec: Spec | None = None, **surface: float) -> Bench:
    """A brick at an odd angle that falls on a corner with friction: an eccentric impact."""
    bodies = {
        "floor": plane(friction=0.5, **surface),
        "brick": box(
            (0.4, 0.2, 0.1),
            (0.0, 0.0, 0.3),
            orientation=(0.9, 0.3, 0.25, 0.1),
            velocity=(1.0, 0.0, -6.0),
            angular_velocity=(0.0, 3.0, 0.0),
            friction=0.5,
            **surface,
        ),
    }
    return interpreted_bench(resolved(bodies, impacts="in_order", timestep="1/100"), spec)


def test_an_impact_with_friction_is_that_of_a_constant_coefficient_of_its_speed() -> None:
    """Newton's law or Stronge's: once the approach speed is known the law is nothing but its e."""
    falling = tilted(**FALLING)
    rows = falling.run(5).contact
    hit = rows[rows["restitution"] > 0.0][0]
    e = float(hit["restitution"])
    assert e == pytest.approx(law(-float(hit["approach_velocity"])), rel=1e-12)
    assert e < 0.7 * E_0
    # The same engine, to compare digits: at a speed that no impact reaches nothing falls.
    constant = tilted(falling.spec, restitution=e, yield_speed=1e6)
    until = int(hit["step"])
    again = tilted(falling.spec, **FALLING)
    again.run(until)
    constant.run(until)
    np.testing.assert_allclose(again.velocity, constant.velocity, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(again.spin, constant.spin, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("surface", [{"yield_speed": 1.0}, {"restitution": 0.5}, {}])
def test_where_nothing_falls_the_effect_is_absent(surface: dict[str, float]) -> None:
    bodies = {"floor": plane(**surface), "ball": sphere(RADIUS, (0.0, 0.0, 1.0), **surface)}
    assert "falling_restitution" not in planned(resolved(bodies)).spec.effects


def test_the_plan_says_above_which_speed_restitution_falls() -> None:
    bodies = {"floor": plane(**FALLING), "ball": sphere(RADIUS, (0.0, 0.0, 1.0), **FALLING)}
    reason = planned(resolved(bodies)).decisions["falling_restitution"].reason
    assert reason == "floor and ball: 0.8 falls above 0.5 m/s"
