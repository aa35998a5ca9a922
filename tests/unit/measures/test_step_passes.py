"""Sums and maxima over the steps of a log, against loops over states and bodies."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.measures.step_passes import (
    LOWEST,
    SO_FAR,
    EnergyRows,
    MomentumRows,
    created,
    fastest,
    imbalance,
    not_finite,
)

STATES, BODIES = 40, 3
RANDOM = np.random.default_rng(5)


def test_what_is_not_finite_is_counted_by_columns_and_by_bodies() -> None:
    step = np.zeros(3, [("step", "i8"), ("x", "f8"), ("y", "f8")])
    pose = np.zeros((3, BODIES, 7))
    step["x"][1], step["y"][1] = np.nan, -np.inf
    pose[2, 0, 1] = pose[2, 0, 5] = np.inf  # two numbers of one pose
    pose[2, 2, 0] = np.nan
    assert not_finite(step, pose).tolist() == [0.0, 2.0, 2.0]


def test_the_fastest_body_is_found_by_a_loop() -> None:
    pose = RANDOM.normal(size=(STATES, BODIES, 7))
    elapsed = RANDOM.uniform(0.01, 0.1, STATES - 1)
    moved = RANDOM.random((STATES - 1, BODIES)) < 0.3
    speeds, bodies = fastest(pose, elapsed, moved)
    assert speeds[0] == 0.0
    for k in range(1, STATES):
        each = [
            0.0
            if moved[k - 1, b]
            else math.dist(pose[k, b, :3], pose[k - 1, b, :3]) / elapsed[k - 1]
            for b in range(BODIES)
        ]
        assert speeds[k] == pytest.approx(max(each), rel=1e-15)
        assert bodies[k] == each.index(max(each))


def test_a_speed_that_is_no_number_is_larger_than_any() -> None:
    pose = np.zeros((2, BODIES, 7))
    pose[1, 0, 0], pose[1, 1, 0] = 5.0, np.nan
    speeds, bodies = fastest(pose, np.ones(1), None)
    assert math.isnan(speeds[1])
    assert bodies[1] == 1


def test_what_no_cause_explains_is_taken_over_all_that_enters() -> None:
    momentum, forces, others, outer = RANDOM.normal(size=(4, STATES, 3))
    kinetic, mass, size = np.abs(RANDOM.normal(size=(3, STATES)))
    gravity, elapsed = np.array([0.1, -0.2, -9.81]), RANDOM.uniform(0.01, 0.1, STATES - 1)
    columns = tuple(momentum[:, k] for k in range(3))
    rows = MomentumRows(columns, kinetic, mass, gravity, forces, others, outer, size, elapsed)
    gaps = imbalance(rows)
    assert gaps[0] == 0.0
    for k in range(1, STATES):
        dt = elapsed[k - 1]
        causes = (mass[k] * gravity + forces[k]) * dt + outer[k] + others[k]
        unexplained = math.dist(momentum[k] - momentum[k - 1], causes)
        enters = size[k] + math.hypot(*others[k])
        enters += math.sqrt(2 * mass[k] * kinetic[k]) + math.sqrt(2 * mass[k - 1] * kinetic[k - 1])
        enters += (mass[k] * math.hypot(*gravity) + math.hypot(*forces[k])) * dt
        assert gaps[k] == pytest.approx(unexplained / enters, rel=1e-13)


def energy(**given: list[float]) -> EnergyRows:
    count = len(next(iter(given.values())))
    rows = {name: np.zeros(count) for name in EnergyRows._fields}
    return EnergyRows(**{**rows, **{name: np.array(one) for name, one in given.items()}})


def begun() -> np.ndarray:
    so_far = np.zeros(SO_FAR)
    so_far[LOWEST] = math.inf
    return so_far


def test_energy_is_created_above_the_lowest_so_far_over_what_is_at_play() -> None:
    """10 J at first and 4 J fallen: what is put in is relative to both, and to work done."""
    rows = energy(kinetic=[10.0, 8.0, 9.0, 9.0], potential=[0.0, 0.0, -4.0, -4.0])
    so_far = begun()
    so_far[-1] = 0.0
    found = created(rows, so_far)
    # own energy 10, 8, 5, 5: never above its lowest
    assert found.tolist() == [0.0, 0.0, 0.0, 0.0]
    rows = energy(kinetic=[10.0, 8.0, 9.0], work=[0.0, 0.0, 1.0])
    assert created(rows, begun())[2] == 0.0  # the work explains it
    rows = energy(kinetic=[10.0, 8.0, 9.0], events=[0.0, 0.0, -1.0])
    at_play = created(rows, begun())
    assert at_play[2] > 0.0  # what was taken away is missing, and yet it rose


def test_sections_run_on_from_one_another() -> None:
    numbers = {name: list(RANDOM.normal(size=30)) for name in EnergyRows._fields}
    whole, so_far = created(energy(**numbers), begun()), begun()
    parts = [
        created(energy(**{name: one[a:b] for name, one in numbers.items()}), so_far)
        for a, b in ((0, 1), (1, 13), (13, 30))
    ]
    np.testing.assert_allclose(np.concatenate(parts), whole, rtol=1e-14)
