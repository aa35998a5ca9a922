"""Balances of a fall: nothing is created to round-off, and what is put in shows by its share."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from lavendersim.measures.balance import EnergyBalance, momentum_imbalance
from lavendersim.measures.contact_sums import ContactSums, summed
from tests.unit.measures.synthetic import GRAVITY, MASS, RADIUS, contacts, scene_of, trace_of

DT, STEPS = 0.01, 41


def fall(numerics: dict[str, float] | None = None, **scene: Any) -> Any:
    """A ball that falls from 2 m by the midpoint rule, which keeps its energy exactly."""
    speeds = -GRAVITY * DT * np.arange(STEPS)
    heights = 2.0 - 0.5 * GRAVITY * (DT * np.arange(STEPS)) ** 2
    ball = {"shape": {"kind": "sphere", "radius": RADIUS}, "mass": MASS}
    floor = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}
    resolved = scene_of({"floor": floor, "ball": ball}, **scene)
    if numerics:
        resolved["numerics"] = resolved["numerics"] | numerics
    log = trace_of(list(heights), speeds=list(speeds), resolved=resolved)
    log.absent = {}
    return log


def at_play(row: int) -> float:
    """First kinetic energy 0, weight times radius, and what the potential energy has fallen by."""
    return MASS * GRAVITY * (RADIUS + 0.5 * GRAVITY * (DT * row) ** 2)


def test_a_fall_creates_nothing_and_a_push_its_share() -> None:
    log = fall()
    created = EnergyBalance().created(log, summed(log))
    assert np.abs(created).max() < 1e-13
    log.step["kinetic_energy"][20:] += 0.5
    created = EnergyBalance().created(log, summed(log))
    expected = [0.5 / at_play(row) for row in range(20, STEPS)]
    np.testing.assert_allclose(created[20:], expected, rtol=1e-11)
    log.step["kinetic_energy"][30:] -= 0.5  # and taken away again
    assert np.abs(EnergyBalance().created(log, summed(log))[30:]).max() < 1e-13


def test_a_loss_lowers_what_later_gains_are_counted_from() -> None:
    log = fall()
    log.step["kinetic_energy"][10:] -= 0.4
    log.step["kinetic_energy"][20:] += 0.3
    created = EnergyBalance().created(log, summed(log))
    assert np.abs(created[:20]).max() < 1e-13
    assert created[25] == pytest.approx(0.3 / at_play(25), rel=1e-11)


@pytest.mark.parametrize("cut", [1, 17, 39])
def test_two_sections_are_one_log(cut: int) -> None:
    log = fall()
    log.step["kinetic_energy"][15:] += 0.5
    whole = EnergyBalance().created(log, summed(log))
    balance = EnergyBalance()
    parts = []
    for first, end in ((0, cut + 1), (cut, STEPS)):
        part = fall()
        part.step, part.pose = log.step[first:end], log.pose[first:end]
        parts.append(balance.created(part, summed(part))[0 if first == 0 else 1 :])
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_work_of_a_force_is_no_creation() -> None:
    """A force of 5 N downwards does 5 N times the way, and speeds the fall up by as much."""
    force = {"body": "ball", "force": [0.0, 0.0, -5.0], "torque": [0.0, 0.0, 0.0], "to": 9.0}
    log = fall(forces=[force])
    pull = GRAVITY + 5.0 / MASS
    heights = 2.0 - 0.5 * pull * (DT * np.arange(STEPS)) ** 2
    log.step["kinetic_energy"] = 0.5 * MASS * (pull * DT * np.arange(STEPS)) ** 2
    log.step["potential_energy"] = MASS * GRAVITY * (heights + RADIUS)
    log.pose[:, 1, 2] = heights + RADIUS
    created = EnergyBalance().created(log, summed(log))
    assert np.abs(created).max() < 1e-12


def test_what_the_projection_lifts_is_its_own() -> None:
    """It may open 0.2 of what exceeds the slop: M |g| times that, and nothing without one."""
    for projection, allowed in ((0.2, 3e-4 * MASS * GRAVITY), (0.0, 0.0)):
        log = fall({"projection": projection})
        sums: ContactSums = summed(log)
        opened = np.zeros(STEPS)
        opened[25] = 3e-4
        log.step["kinetic_energy"][25:] += 0.5
        created = EnergyBalance().created(log, sums._replace(opened=opened))
        assert created[25] == pytest.approx((0.5 - allowed) / at_play(25), rel=1e-9)


def test_momentum_of_a_fall_is_balanced_and_a_kick_shows_over_what_enters() -> None:
    log = fall()
    assert momentum_imbalance(log, summed(log)).max() < 1e-13
    log.step["momentum_x"][30:] = 0.25
    gaps = momentum_imbalance(log, summed(log))
    # a ball alone: sqrt(2 M E_k) = M |v|
    carried = [MASS * GRAVITY * DT * row for row in (29, 30)]
    assert gaps[30] == pytest.approx(0.25 / (MASS * GRAVITY * DT + sum(carried)), rel=1e-12)
    assert np.delete(gaps, 30).max() < 1e-13


def test_an_impulse_of_a_contact_is_a_cause_and_its_absence_a_gap() -> None:
    log = fall()
    log.step["momentum_z"][30:] += 4.0
    missing = momentum_imbalance(log, summed(log))[30]
    log.contact = contacts([(30, 4.0, 0.0)])  # of the floor on the ball, along +z
    assert momentum_imbalance(log, summed(log))[30] < 1e-13
    assert missing > 0.1
    assert math.isfinite(missing)
