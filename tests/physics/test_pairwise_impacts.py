"""Impacts of one instant, two bodies at a time: touching bodies as the limit of small gaps.

Closed forms of rows of balls, the conservation laws, and the same scenes with gaps of a micrometre,
whose impacts have an order of their own.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from shared_runs import GRAVITY, States, ball, config, plane, run_scenes

RADIUS = 0.05  # [m]
RATES = (60, 1000)
# An impact is solved to the default tolerance of a step [m/s]; a row of five is some ten of them.
IMPACTS = 1e-8
# What a gap of a micrometre lets the bodies of a row move before they meet, in speeds of 1 m/s.
GAP = 1e-6


def by(law: str, text: str) -> str:
    """Return the config under a law of simultaneous impacts."""
    return text.replace("numerics: {", f"numerics: {{simultaneous_impacts: {law}, ")


def row(strikers: int, masses: list[float], rate: int, gap: float = 0.0, e: float = 1.0) -> str:
    """Balls in a row strike others at rest from 20 mm and a part of a step, at 1 m/s."""
    lead, pitch = 0.02 + 0.4 / rate, 2.0 * RADIUS + gap
    bodies = {
        f"b{k}": ball(RADIUS, mass, (k * pitch - (lead if k < strikers else 0.0), 0, 0), (v, 0, 0))
        for k, mass in enumerate(masses)
        for v in [1.0 if k < strikers else 0.0]
    }
    seconds = math.ceil((lead + 0.01) * rate + 1) / rate
    return config(bodies, rate, seconds, f"restitution: {e}")


def rack(rate: int) -> str:
    """A ball strikes three that touch each other, head on between the first two of them."""
    height = RADIUS * math.sqrt(3.0)
    places = [(-0.3, 0.0), (0.0, RADIUS), (0.0, -RADIUS), (height, 0.0)]
    bodies = {
        f"b{k}": ball(RADIUS, 1.0, (x, y, 0), (2.0 if k == 0 else 0.0, 0, 0))
        for k, (x, y) in enumerate(places)
    }
    return config(bodies, rate, 0.2)


def drop(rate: int) -> str:
    """A ball falls on one of three times its mass that lies on the floor."""
    lead = 0.2
    bodies = {
        "floor": plane(),
        "lower": ball(0.1, 3.0, (0, 0, 0.1)),
        "upper": ball(0.1, 1.0, (0, 0, 0.3 + lead)),
    }
    seconds = math.ceil((math.sqrt(2.0 * lead / GRAVITY) + 0.01) * rate) / rate
    return config(bodies, rate, seconds, gravity=repr(GRAVITY))


FALLING = [1.0, 0.5, 0.8, 0.3, 0.6]


def scenes() -> dict[str, str]:
    found = {}
    for rate in RATES:
        found[f"two {rate}"] = by("pairwise", row(2, [1.0] * 7, rate))
        found[f"masses {rate}"] = by("pairwise", row(1, FALLING, rate))
        found[f"apart {rate}"] = by("pairwise", row(1, FALLING, rate, GAP))
        found[f"lossy {rate}"] = by("pairwise", row(1, FALLING, rate, e=0.6))
        found[f"rack {rate}"] = by("pairwise", rack(rate))
        found[f"drop {rate}"] = by("pairwise", drop(rate))
    return found


@pytest.fixture(scope="module")
def ran() -> dict[str, States]:
    return run_scenes(scenes())


@pytest.fixture(scope="module")
def together() -> dict[str, States]:
    found = {f"drop {rate}": by("together", drop(rate)) for rate in RATES}
    return run_scenes({"two": by("together", row(2, [1.0] * 7, 240)), **found})


def one_after_the_other(masses: list[float], speeds: list[float], e: float) -> np.ndarray:
    """Return the speeds of a row after its impacts: the fastest approach first, until none is."""
    m, v = np.array(masses), np.array(speeds)
    while True:
        approach = v[:-1] - v[1:]
        k = int(np.argmax(approach))
        if approach[k] <= 1e-12:
            return v
        impulse = (1.0 + e) * approach[k] * m[k] * m[k + 1] / (m[k] + m[k + 1])
        v[k] -= impulse / m[k]
        v[k + 1] += impulse / m[k + 1]


@pytest.mark.parametrize("rate", RATES)
def test_of_seven_touching_balls_two_strike_and_two_leave(
    ran: dict[str, States], rate: int
) -> None:
    speeds = ran[f"two {rate}"].velocity[-1, :, 0]
    np.testing.assert_allclose(speeds, [0, 0, 0, 0, 0, 1, 1], atol=IMPACTS)


def test_together_the_same_balls_leave_otherwise(together: dict[str, States]) -> None:
    """Newton's law for all at once: each contact's own rebound, so that all of them part."""
    speeds = together["two"].velocity[-1, :, 0]
    assert abs(speeds - [0, 0, 0, 0, 0, 1, 1]).max() > 0.1


@pytest.mark.parametrize("e", [1.0, 0.6])
@pytest.mark.parametrize("rate", RATES)
def test_a_row_hands_on_a_blow_pair_by_pair(ran: dict[str, States], rate: int, e: float) -> None:
    states = ran[f"{'masses' if e == 1.0 else 'lossy'} {rate}"]
    expected = one_after_the_other(FALLING, [1.0, 0, 0, 0, 0], e)
    np.testing.assert_allclose(states.velocity[-1, :, 0], expected, atol=IMPACTS)


@pytest.mark.parametrize("rate", RATES)
def test_touching_is_the_limit_of_small_gaps(ran: dict[str, States], rate: int) -> None:
    """Of balls that leave in the order in which they strike: the masses do not bring them back."""
    touching, apart = (ran[f"{name} {rate}"].velocity[-1, :, 0] for name in ("masses", "apart"))
    np.testing.assert_allclose(touching, apart, atol=2.0 * IMPACTS)


@pytest.mark.parametrize("rate", RATES)
def test_what_is_symmetric_stays_so_and_energy_and_momentum_stay(
    ran: dict[str, States], rate: int
) -> None:
    states = ran[f"rack {rate}"]
    (_, upper, lower, _), v = states.velocity[-1], states.velocity
    assert upper[0] == pytest.approx(lower[0], abs=IMPACTS)
    assert upper[1] == pytest.approx(-lower[1], abs=IMPACTS)
    assert upper[1] > 0.1
    energy = (v**2).sum(axis=(1, 2))
    assert abs(energy - energy[0]).max() <= 4.0 * 2.0 * IMPACTS
    assert abs(v.sum(axis=1) - v[0].sum(axis=0)).max() <= 4.0 * IMPACTS


@pytest.mark.parametrize("rate", RATES)
def test_a_ball_on_the_floor_hands_the_blow_to_the_floor_and_back(
    ran: dict[str, States], rate: int
) -> None:
    """v on 1 and 3 kg: -v/2 and v/2; the floor turns the 3 kg back, and both go up with v/2."""
    states = ran[f"drop {rate}"]
    v = math.sqrt(2.0 * GRAVITY * 0.2)
    flown = states.time[-1] - v / GRAVITY
    speeds = states.velocity[-1, 1:, 2]
    np.testing.assert_allclose(speeds, 0.5 * v - GRAVITY * flown, atol=IMPACTS)


@pytest.mark.parametrize("rate", RATES)
def test_together_the_ball_on_the_floor_stays(together: dict[str, States], rate: int) -> None:
    """It is held until it is met: free it would fall by up to 1.4 mm."""
    states = together[f"drop {rate}"]
    v = math.sqrt(2.0 * GRAVITY * 0.2)
    flown = states.time[-1] - v / GRAVITY
    speeds = states.velocity[-1, 1:, 2]
    np.testing.assert_allclose(speeds, [0.0, v - GRAVITY * flown], atol=IMPACTS)


@pytest.mark.parametrize("rate", RATES)
def test_a_ball_that_its_floor_holds_while_it_slides_is_met_on_its_surface(rate: int) -> None:
    """Gravity leans against the thrown one, which has as much of it along the floor, and falls."""
    thrown = ball(RADIUS, 1.0, (-0.4, 0.0, 0.15), (2.0, 0.0, 0.2))
    bodies = {"floor": plane(), "slides": ball(0.1, 1.0, (0, 0, 0.1)), "thrown": thrown}
    text = config(bodies, rate, 0.2, "restitution: 0.5", f"[-2, 0, {-GRAVITY}]")
    (states,) = run_scenes({"thrown": text}).values()
    rows = states.contact[(states.contact["body_a"] == 1) & (states.contact["body_b"] == 2)]
    # Located to 1e-9 m; g dt^2/2 were 1.4 mm at 60 Hz.
    assert abs(rows["separation"][0]) <= 1e-9
    assert rows["impulse_n"][0] > 0.1
