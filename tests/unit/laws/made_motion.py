"""Motions of one step, made by hand: the states before and after it, whatever law they break.

A ball of 2 kg and 0.1 m stands on a plane; the timestep is 1/100 s and gravity 10 m/s^2. A
falsified step is a true one with an impulse more, whose effect on velocities has a closed form.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lavendersim.experiment.load import load_experiment_text
from lavendersim.laws.motion import RecordedMotion

DT, G, MASS, RADIUS = 0.01, 10.0, 2.0, 0.1
INERTIA = 0.4 * MASS * RADIUS**2
BALL = """\
scene:
  gravity: {gravity}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: {{friction: 0.5, restitution: {e}}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 2
      surface: {{friction: 0.5, restitution: {e}}}
      position: [0, 0, 0.1]
numerics: {{timestep: 1/100}}
duration: 1
record: {{velocities: true}}
"""
BALLS = """\
scene:
  gravity: 0
  bodies:
    left: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 0]}
    right: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0.3, 0, 0]}
numerics: {timestep: 1/100}
duration: 1
"""


def ball(gravity: float = G, e: float = 0.0) -> str:
    """Return the config of the ball on its plane."""
    return BALL.format(gravity=[0, 0, -gravity], e=e)


def motion(text: str, pose: np.ndarray, velocity: np.ndarray) -> RecordedMotion:
    """Return a motion of states (rows, bodies, 7) and (rows, bodies, 6)."""
    text = "question: Which law?\nexpected: The one that was broken.\n" + text
    config = load_experiment_text(text, "made.yaml").cells()[0].config
    names = tuple(config.scene.bodies)
    steps = np.arange(len(pose), dtype=np.int64)
    return RecordedMotion(Path("made.mcap"), config, names, config.clock, steps, pose, velocity)


def states(*of_ball: tuple[list[float], list[float]]) -> tuple[np.ndarray, np.ndarray]:
    """Return poses and velocities of the floor and the ball; each its place, then six numbers."""
    pose, velocity = np.zeros((len(of_ball), 2, 7)), np.zeros((len(of_ball), 2, 6))
    pose[:, :, 3] = 1.0
    for row, (place, speeds) in enumerate(of_ball):
        pose[row, 1, :3], velocity[row, 1] = place, speeds
    return pose, velocity


def given(impulse: list[float]) -> np.ndarray:
    """Return what an impulse [N s] at the ball's lowest point does to velocity and spin (6,)."""
    lever = np.array([0.0, 0.0, -RADIUS])
    return np.concatenate([np.array(impulse) / MASS, np.cross(lever, impulse) / INERTIA])
