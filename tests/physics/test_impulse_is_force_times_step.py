"""The reported force is the step's impulse over its length; shorter steps show taller spikes."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

E, H, BETA, MASS = 0.3, 1.0, 0.02, 1.5
DROPS = f"""
scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: {MASS}
      surface: {{restitution: {E}}}
      release: {{above: floor, clearance: {H}}}
numerics: {{preset: chapter, projection: 0}}
duration: 1.0
sweep:
  timestep: {{path: numerics.timestep, values: [1/120, 1/240, 1/480, 1/960]}}
"""


@pytest.fixture(scope="module")
def drops() -> list[Course]:
    return run_config(DROPS)


def test_force_is_impulse_over_timestep(drops: list[Course]) -> None:
    for drop in drops:
        # One division, rounded once: equal to the last bit.
        assert np.array_equal(drop.contact["force_n"], drop.contact["impulse_n"] / drop.dt)


def test_impulses_are_the_change_of_momentum_and_the_weight(drops: list[Course]) -> None:
    for drop in drops:
        steps = np.arange(len(drop.step))
        impulses = np.bincount(drop.contact["step"], drop.contact["impulse_n"], len(steps))
        expected = np.cumsum(impulses) - MASS * GRAVITY * drop.dt * steps
        # A step adds g dt and an impulse to a speed below 5 m/s: two roundings of 7.5 kg m/s each.
        round_off = 2 * len(steps) * 2.2e-16 * 7.5
        assert drop.step["momentum_z"] == pytest.approx(expected, abs=round_off)


def test_a_shorter_step_shows_a_taller_spike_of_the_same_impulse(drops: list[Course]) -> None:
    for drop in drops:
        peak = drop.contact["force_n"].max()
        # The ball arrives at v = sqrt(2 g (h + d)) + g dt/2 and a little more, d in 0 .. v dt; the
        # impulse is m ((1 + e) v + b), with a bias b of at most (beta/dt) d.
        slowest = sqrt(2 * GRAVITY * H)
        d = 1.02 * slowest * drop.dt
        fastest = sqrt(2 * GRAVITY * (H + d)) + GRAVITY * drop.dt
        impulse = peak * drop.dt
        assert MASS * (1 + E) * slowest <= impulse
        assert impulse <= MASS * ((1 + E) * fastest + BETA / drop.dt * d)
    peaks = [drop.contact["force_n"].max() for drop in drops]
    assert np.diff(peaks).min() > 0
