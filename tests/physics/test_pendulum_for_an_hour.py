"""A pendulum on a hinge swings for an hour: its energy stays, and its period is its amplitude's.

At the middle of a step a joint does no work, so that energy goes by what solves leave: a velocity
of 1e-9 m/s, along which the joint's impulse p does work, 1e-9 |p| a step.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ellipk
from shared_runs import GRAVITY

from lavendersim.experiment import load_experiment_text
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.build import build

RATE, DURATION = 60, 3600  # [1/s], [s]
LENGTH, RADIUS, ANGLE = 0.5, 0.1, 1.4
LEFT = 1e-9  # of a velocity by a solve [m/s]
TEXT = f"""\
scene:
  bodies:
    hook: {{shape: {{kind: sphere, radius: 0.01}}, fixed: true, position: [0, 0, 0]}}
    bob:
      shape: {{kind: sphere, radius: {RADIUS}}}
      mass: 1
      position: [{LENGTH * math.sin(ANGLE)!r}, 0, {-LENGTH * math.cos(ANGLE)!r}]
  connections:
    pivot: {{kind: hinge, between: [hook, bob], at: [0, 0, 0], axis: [0, 1, 0]}}
numerics: {{timestep: 1/{RATE}}}
duration: {DURATION}
"""


def swings() -> tuple[np.ndarray, np.ndarray]:
    """Return the energy [J] and the way along x [m] of the bob after every step."""
    (cell,) = load_experiment_text(TEXT, "pendulum.yaml").cells()
    (plan,) = shared_plans([cell])
    scene = build(cell.config, plan.spec)  # no family's: its steps cost five times as much
    engine, bob = scene.engine(plan.spec), scene.names.index("bob")
    energy, x = [], []
    for _ in range(DURATION):  # rows of contacts are let go second by second
        engine.advance(RATE)
        step, pose, _, _ = engine.take_rows()
        energy.append(step["kinetic_energy"] + step["potential_energy"])
        x.append(pose[:, bob, 0].copy())
    return np.concatenate(energy), np.concatenate(x)


def test_a_pendulum_keeps_its_energy_and_its_period_for_an_hour() -> None:
    energy, x = swings()
    assert len(energy) == RATE * DURATION + 1
    # The joint pulls by m g + m v^2/l at the lowest place, and v^2 <= 2 g l (1 - cos a0).
    most = GRAVITY * (3.0 - 2.0 * math.cos(ANGLE)) / RATE
    drift = energy[2:] - energy[2]  # the first step, from rest, had no middle
    assert abs(drift).max() <= LEFT * most * len(energy)
    swung = math.sqrt((LENGTH**2 + 0.4 * RADIUS**2) / (GRAVITY * LENGTH))
    period = 4.0 * swung * ellipk(math.sin(0.5 * ANGLE) ** 2)
    down = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
    crossed = (down + x[down] / (x[down] - x[down + 1])) / RATE
    found = (crossed[-1] - crossed[0]) / (len(crossed) - 1)
    # (w dt)^2/8 of it at small angles, w = 1/swung; half as much again at this one.
    assert abs(found / period - 1.0) <= 0.2 / (swung * RATE) ** 2
