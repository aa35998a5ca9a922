"""Bodies may be fast where the energy that there is could move two of them so far in a step.

Bounds by closed forms; the timestep at which the decision turns is that of the bound.
"""

from __future__ import annotations

from math import inf, sqrt
from types import SimpleNamespace
from typing import Any

import pytest
from plain_facts import body_facts, facts, pair_facts

from lavendersim.engine.effects.fast_bodies import EFFECT, FAST, SAFETY

SIZE = 0.1


def ball(name: str, mass: float, speed: float = 0.0, height: float = 0.0, **more: Any):
    config = SimpleNamespace(
        mass=mass, inertia=(0.01, 0.02, 0.03), angular_velocity=more.pop("spin", (0.0, 0.0, 0.0)),
        position=(0.0, 0.0, height), surface_velocity=more.pop("belt", (0.0, 0.0, 0.0)),
    )  # fmt: skip
    return body_facts(
        name, "sphere", config=config, speed=speed, size=SIZE, least_size=SIZE, **more
    )


def floor(normal=(0.0, 0.0, 1.0), offset: float = 0.0):
    config = SimpleNamespace(
        shape=SimpleNamespace(normal=normal, offset=offset), surface_velocity=(0.0, 0.0, 0.0)
    )
    return body_facts("floor", "plane", movable=False, config=config, size=inf, least_size=inf)


def turning_point(*bodies: Any, **scene: Any) -> float:
    """Return the closing speed by the timestep from which the scene requires the effect."""
    pairs = (pair_facts("one", "two"),)

    def on(dt: float) -> bool:
        known = {"pairs": pairs, "speculative": True, "duration": 2.0, **scene}
        return EFFECT.decide(facts(*bodies, timestep=dt, **known)).on

    low, high = 1e-9, 1e3
    assert on(high)
    assert not on(low)
    for _ in range(200):
        middle = sqrt(low * high)
        low, high = (low, middle) if on(middle) else (middle, high)
    return FAST * SIZE / (SAFETY * low)


def test_all_kinetic_energy_may_go_into_two_bodies() -> None:
    """sqrt(2 E (1/m_1 + 1/m_2)), of the two lightest; a spin has energy by its largest moment."""
    bodies = ball("one", 2.0, 3.0), ball("two", 0.5, 1.0, spin=(0.0, 3.0, 4.0)), ball("three", 9.0)
    energy = 0.5 * 2.0 * 9.0 + 0.5 * 0.5 * 1.0 + 0.5 * 0.03 * 25.0
    expected = sqrt(2.0 * energy * (1.0 / 2.0 + 1.0 / 0.5))
    assert turning_point(*bodies) == pytest.approx(expected, rel=1e-9)


def test_above_a_floor_the_heights_count_and_without_one_the_time() -> None:
    """m g (h + r) over the floor; falling for T: sqrt(2 E) <= g T sqrt(sum m), from rest."""
    g, bodies = 9.81, (ball("one", 2.0, height=0.5), ball("two", 0.5, height=1.5))
    scene = {"gravity": (0.0, 0.0, -g)}
    per_mass = 1.0 / 2.0 + 1.0 / 0.5
    falling = g * 2.0 * sqrt(2.5)
    assert turning_point(*bodies, **scene) == pytest.approx(falling * sqrt(per_mass), rel=1e-9)
    leaning = floor((0.0, 0.6, 0.8))
    assert turning_point(leaning, *bodies, **scene) == pytest.approx(
        falling * sqrt(per_mass), rel=1e-9
    )
    over = g * (2.0 * (0.5 + 0.25 + SIZE) + 0.5 * (1.5 + 0.25 + SIZE))
    found = turning_point(floor(offset=-0.25), *bodies, **scene)
    assert found == pytest.approx(sqrt(2.0 * over * per_mass), rel=1e-9)


@pytest.mark.parametrize(
    ("body", "scene"),
    [
        ({"force": True}, {}),
        ({"torque": True}, {}),
        ({"pulled": True}, {}),
        ({"kinematic": True, "spins": True}, {}),
        ({"belt": (0.1, 0.0, 0.0)}, {}),
        ({}, {"events": True}),
        ({}, {"later_gravity": ((0.0, 0.0, -1.0),)}),
        ({}, {"stabilisation_gain": 0.2}),
        ({}, {"pairs": (pair_facts("one", "two", compliance=1e-5),)}),
        ({}, {"pairs": (pair_facts("one", "two", restitution=0.5),)}),
    ],
)
def test_what_may_give_energy_leaves_no_bound(body: dict[str, Any], scene: dict[str, Any]) -> None:
    known = {"pairs": (pair_facts("one", "two"),), "speculative": True, "timestep": 1e-9, **scene}
    still = facts(ball("one", 1.0), ball("two", 1.0), **known)
    found = EFFECT.decide(facts(ball("one", 1.0, **body), ball("two", 1.0), **known))
    assert found.on
    assert "no bound" in found.reason
    assert EFFECT.decide(still).on is bool(scene)


def test_restitution_at_the_surface_gives_nothing() -> None:
    pairs = (pair_facts("one", "two", restitution=0.5),)
    bodies = ball("one", 1.0), ball("two", 1.0)
    known = {"pairs": pairs, "speculative": True, "timestep": 1e-9, "impacts": "at_surface"}
    assert not EFFECT.decide(facts(*bodies, **known)).on
    assert not EFFECT.decide(facts(*bodies, **(known | {"speculative": False}))).on


def test_a_plane_s_normal_is_everywhere_alike() -> None:
    pairs = (pair_facts("floor", "one"),)
    fast = facts(floor(), ball("one", 1.0, 1e6), pairs=pairs, speculative=True, timestep=1.0)
    assert not EFFECT.decide(fast).on
