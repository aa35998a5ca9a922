"""A compliant contact rests at d - slop = c N / beta: a force law, not a matter of the solver.

The row balances at gamma lambda = (beta/dt)(d - slop) with gamma = c/dt^2 and lambda = N dt; every
dt cancels, and so does the number of sweeps. Divided by dt, gamma would leave d - slop in
proportion to dt.
"""

from __future__ import annotations

import pytest
from physics_runs import GRAVITY, Course, run_config

R, SLOP, BETA, C = 0.1, 0.001, 0.02, 1e-5
COLUMN = """
scene:
  surfaces: {soft: {compliance: 0.5e-5}, hard: {}}
  bodies:
    floor: {shape: {kind: plane}, surface: soft}
    lower: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: soft, position: [0, 0, 0.1]}
    middle: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: soft, position: [0, 0, 0.3]}
    upper: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, surface: soft, position: [0, 0, 0.5]}
numerics: {preset: chapter, projection: 0}
duration: 6.0
sweep:
  - sweeps: {path: numerics.sweeps, values: [22, 100, 400]}
  - timestep: {path: numerics.timestep, values: [1/480]}
"""
# The column settles like exp(-beta t/dt) = exp(-4.8 t/s) at 240 Hz: 3e-13 of the way after 6 s.
SETTLED = 1e-6


@pytest.fixture(scope="module")
def columns() -> list[Course]:
    return run_config(COLUMN)


def excess(course: Course, lower: str, upper: str) -> float:
    """Return d - slop at the end [m]."""
    return float(course.contacts_of(lower, upper)["penetration"][-1]) - SLOP


LAYERS = [("floor", "lower", 3), ("lower", "middle", 2), ("middle", "upper", 1)]


@pytest.mark.parametrize(("below", "above", "balls"), LAYERS)
def test_penetration_is_load_times_compliance_over_gain(
    columns: list[Course], below: str, above: str, balls: int
) -> None:
    expected = C * balls * 1.0 * GRAVITY / BETA
    for course in columns:
        assert excess(course, below, above) == pytest.approx(expected, rel=SETTLED)


def test_more_sweeps_do_not_stiffen_the_contact(columns: list[Course]) -> None:
    for below, above, _ in LAYERS:
        depths = [excess(course, below, above) for course in columns[:3]]
        assert depths == pytest.approx([depths[0]] * 3, rel=SETTLED)


def test_penetration_is_the_same_at_240_and_480_hertz(columns: list[Course]) -> None:
    at_240, at_480 = columns[0], columns[3]
    assert at_480.dt == at_240.dt / 2
    for below, above, _ in LAYERS:
        assert excess(at_480, below, above) == pytest.approx(
            excess(at_240, below, above), rel=SETTLED
        )
