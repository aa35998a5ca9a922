"""Tangential restitution: Garwin's superball between two walls, by the two balances of momentum.

    J (1/m + R^2/I) = -(1 + e_t) s,   |J| <= mu (1 + e) m v_n
Kernels run in the interpreter: nothing is compiled.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted_steps import interpreted_bench
from laboratory import Bench, plane, planned, resolved, sphere

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.resolve.presets import DEFAULT

RADIUS, HIGH, V_N = 0.1, 0.5, 3.0
# Each impact is solved to 1e-13 m/s in its own part of a step.
SHARP = {"tolerance": 1e-13, "sweeps": 400}
LEFT = 1e-12


def between_walls(gives: float, mu: float = 10.0, e: float = 1.0, **given: Any) -> Bench:
    """A ball that flies from the floor's to the ceiling's side, without gravity."""
    surface = {"friction": mu, "restitution": e, "tangential_restitution": gives}
    bodies = {
        "floor": plane(**surface),
        "ceiling": plane((0.0, 0.0, -1.0), -HIGH, **surface),
        "ball": sphere(RADIUS, (0.0, 0.0, 0.25), **surface, **given),
    }
    cell = resolved(bodies, **{**DEFAULT.model_dump(mode="json"), **SHARP})
    return interpreted_bench(cell, planned(cell).spec)


def bounced(v: float, spin: float, side: float, gives: float, most: float) -> tuple[float, float]:
    """Return v_x and omega_y after an impact; side: -1 on the floor, 1 at the ceiling; mass 1."""
    moment = 0.4 * RADIUS**2
    slip = v + side * RADIUS * spin
    push = -(1.0 + gives) * slip / (1.0 + RADIUS**2 / moment)
    push = min(max(push, -most), most)
    return v + push, spin + side * RADIUS * push / moment


def motion(bench: Bench) -> tuple[float, float]:
    return float(bench.velocity[2, 0]), float(bench.engine.velocities["wy"][2])


@pytest.mark.parametrize("gives", [1.0, 0.6])
def test_a_superball_between_floor_and_ceiling(gives: float) -> None:
    bench = between_walls(gives, velocity=(1.0, 0.0, -V_N), angular_velocity=(0.0, 2.0, 0.0))
    v, spin = 1.0, 2.0
    seen = [(v, spin)]
    for _ in range(120):
        bench.run(1)
        if abs(motion(bench)[0] - seen[-1][0]) > 1e-6:
            seen.append(motion(bench))
    # 0.15 m to the floor and 0.3 m from wall to wall, at 3 m/s: five impacts in half a second.
    assert len(seen) == 6
    for k, found in enumerate(seen[1:]):
        v, spin = bounced(v, spin, -1.0 if k % 2 == 0 else 1.0, gives, 1e9)
        assert found == pytest.approx((v, spin), abs=10 * LEFT / RADIUS)
    energy = 0.5 * v * v + 0.2 * RADIUS**2 * spin * spin
    assert (energy == pytest.approx(0.5 + 0.2 * RADIUS**2 * 4.0, rel=1e-11)) == (gives == 1.0)


def test_without_spin_it_leaves_with_three_sevenths_of_its_speed() -> None:
    bench = between_walls(1.0, velocity=(1.0, 0.0, -V_N))
    bench.run(20)
    assert motion(bench)[0] == pytest.approx(3.0 / 7.0, abs=10 * LEFT)


def test_what_the_cone_cannot_give_back_stays_slip() -> None:
    mu, e = 0.05, 0.5
    bench = between_walls(1.0, mu, e, velocity=(1.0, 0.0, -V_N))
    bench.run(20)
    most = mu * (1.0 + e) * V_N
    assert most < 4.0 / 7.0
    assert motion(bench) == pytest.approx(
        bounced(1.0, 0.0, -1.0, 1.0, most), abs=10 * LEFT / RADIUS
    )


def test_a_contact_that_lasts_gives_nothing_back() -> None:
    def rolling(gives: float) -> tuple[float, float]:
        surface = {"friction": 0.3, "tangential_restitution": gives}
        bodies = {
            "floor": plane(**surface),
            "ball": sphere(RADIUS, (0.0, 0.0, RADIUS), velocity=(1.0, 0.0, 0.0), **surface),
        }
        cell = resolved(bodies, (0.0, 0.0, -9.81), **{**DEFAULT.model_dump(mode="json"), **SHARP})
        bench = interpreted_bench(cell, planned(cell).spec)
        bench.run(6)
        return float(bench.velocity[1, 0]), float(bench.engine.velocities["wy"][1])

    np.testing.assert_allclose(rolling(1.0), rolling(0.0), rtol=1e-14)


@pytest.mark.parametrize("approach", [1e-16, -1e-16])
def test_what_meets_by_round_off_alone_gives_nothing_back(approach: float) -> None:
    """It slides down a wall, and meets a frictionless slope, which presses it to the wall."""
    frictional = {"friction": 1.0, "tangential_restitution": 0.2}
    bodies = {
        "slope": plane((-0.6, 0.0, 0.8), -0.064, friction=0.0),
        "wall": plane((1.0, 0.0, 0.0), 0.0, **frictional),
        "ball": sphere(RADIUS, (RADIUS, 0.0, 0.1), velocity=(approach, 0.0, -V_N), **frictional),
    }
    cell = resolved(bodies, **{**DEFAULT.model_dump(mode="json"), **SHARP})
    bench = interpreted_bench(cell, planned(cell).spec)
    bench.run(1)
    assert motion(bench) == pytest.approx((0.0, 0.0), abs=1e-8)


def test_each_of_two_bounces_in_a_step_reverses_the_slip() -> None:
    """At e = 0.8 from 0.06 m/s the second comes 2 e v/g = 9.8 ms after the first, of 16.7."""
    surface = {"friction": 10.0, "restitution": 0.8, "tangential_restitution": 1.0}
    ball = sphere(RADIUS, (0.0, 0.0, RADIUS), velocity=(1.0, 0.0, -0.06), **surface)
    numerics = {**DEFAULT.model_dump(mode="json"), **SHARP, "timestep": "1/60"}
    cell = resolved({"floor": plane(**surface), "ball": ball}, (0.0, 0.0, -9.81), **numerics)
    bench = interpreted_bench(cell, planned(cell).spec)
    bench.run(1)
    v = float(bench.velocity[1, 0]), float(bench.engine.velocities["wy"][1])
    expected = bounced(*bounced(1.0, 0.0, -1.0, 1.0, 1e9), -1.0, 1.0, 1e9)
    assert expected == pytest.approx((1.0, 0.0), abs=1e-14)  # Garwin's
    assert v == pytest.approx(expected, abs=10 * LEFT / RADIUS)


def test_where_no_slip_is_given_back_the_effect_is_absent() -> None:
    assert "tangential_restitution" not in between_walls(0.0).spec.effects


@pytest.mark.parametrize(
    ("numerics", "why"),
    [
        ("impacts: captured", "impacts are captured, which"),
        ("impacts: at_surface", "impacts are at_surface, where"),
        ("stabilisation_gain: 0.2", "stabilisation_gain is above 0, so"),
    ],
)
def test_impacts_without_order_are_refused_where_the_key_stands(numerics: str, why: str) -> None:
    text = f"""
scene:
  surfaces: {{super: {{friction: 0.3, tangential_restitution: 1}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: super}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, 1], surface: super}}
numerics: {{timestep: 1/240, {numerics}}}
duration: 1
"""
    with pytest.raises(ConfigError, match=rf"3:.*tangential_restitution: {why}"):
        load_experiment_text(text, "super.yaml").cells()
