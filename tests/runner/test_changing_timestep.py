"""A ball bounces on while its timestep changes: every time and place lands on the closed form."""

from __future__ import annotations

from fractions import Fraction
from math import sqrt

import numpy as np
import pytest

import lavendersim
from lavendersim.runner.experiment_run import Finished
from lavendersim.trace import Trace, open_trace

G, HEIGHT, RADIUS = 9.81, 1.0, 0.1
BALL = """
scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {restitution: 1}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 2
      surface: {restitution: 1}
      release: {above: floor, clearance: 1.0}
numerics: {timestep: 1/240}
duration: 4.5
record: {residuals: none}
always: {}
events:
  - {at: 1.905, timestep: 1/37} # as they come, not in the order of time
  - {at: 0.1, timestep: 1/60}
  - {at: 1.0, timestep: 1/1000}
  - {at: 3.0, timestep: 1/240}
"""
# Each change is reached by whole steps: 24 of 1/240, 54 of 1/60, 905 of 1/1000; then 41 of 1/37 end
# behind 3 s, and 357 of 1/240 behind 4.5 s.
CHANGES = [(24, "1/60"), (78, "1/1000"), (983, "1/37"), (1024, "1/240")]
LATE = Fraction("1.905") + Fraction(41, 37)
STEPS = 1024 + 357


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("changing")
    config = folder / "ball.yaml"
    config.write_text(BALL)
    return lavendersim.run(config, root=folder)


@pytest.fixture(scope="module")
def trace(finished: Finished) -> Trace:
    return open_trace(next((finished.run.path / "cells").glob("*.mcap")))


def test_the_log_knows_the_time_and_length_of_every_step(trace: Trace) -> None:
    assert trace.clock.changes == [(done, Fraction(length)) for done, length in CHANGES]
    assert trace.timestep == Fraction(1, 240)
    assert trace.step["step"].tolist() == list(range(STEPS + 1))
    ends = [0, 24, 78, 983, 1024, STEPS]
    lengths = ["1/240", "1/60", "1/1000", "1/37", "1/240"]
    exact = [Fraction(0)]
    for first, last, length in zip(ends[:-1], ends[1:], lengths, strict=True):
        exact += [exact[-1] + k * Fraction(length) for k in range(1, last - first + 1)]
        assert set(trace.timesteps[first + 1 : last + 1]) == {float(Fraction(length))}
    assert exact[1024] == LATE
    assert trace.step["time_ns"].tolist() == [int(time * 10**9) for time in exact]
    assert exact[-2] < Fraction("4.5") <= exact[-1]


def test_flight_and_bounces_stay_on_the_closed_form(trace: Trace) -> None:
    """h - g tau^2 / 2, tau the time to the nearest apex. A step rounds speed and place four times,
    and an error of the speed grows with what is left of the run.
    """
    time = np.array([float(trace.clock.time(step)) for step in range(STEPS + 1)])
    fall = sqrt(2.0 * HEIGHT / G)
    tau = (time + fall) % (2.0 * fall) - fall
    height = HEIGHT - 0.5 * G * tau**2
    ball = trace.pose[:, trace.bodies.index("ball")]
    allowed = STEPS * 4 * 2.0**-53 * (G * fall * time[-1] + HEIGHT)
    assert allowed < 2e-11
    assert np.abs(ball[:, 2] - RADIUS - height).max() <= allowed
    assert (trace.step["contact_count"] > 0).any()


def test_no_change_gives_or_takes_energy(finished: Finished, trace: Trace) -> None:
    energy = trace.step["kinetic_energy"] + trace.step["potential_energy"]
    assert np.abs(energy / energy[0] - 1.0).max() <= STEPS * 8 * 2.0**-53
    assert finished.good  # among it energy, momentum and residual of every step


def test_the_simulator_takes_the_same_steps(finished: Finished, trace: Trace) -> None:
    sim = lavendersim.Simulator(finished.run.path / "config.yaml")
    assert sim.timestep == 1 / 240
    for step in range(1, 85):
        observation, _, _, truncated, info = sim.step()
        assert sim.timestep == trace.timesteps[step]
        assert info["time"] == pytest.approx(trace.step["time"][step], abs=1e-9)
        assert observation["bodies"]["position"].tobytes() == trace.pose[step, :, :3].tobytes()
        assert not truncated
    assert info["time"] == 1.006
