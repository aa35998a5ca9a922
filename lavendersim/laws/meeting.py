"""Where bodies are when they first meet within a step: an impact bends their path there.

From the state before, each body flies on until the first of its contacts that has a gap closes, by
the mean of its velocities with and without the forces of the step; one that meets nothing stays.
"""

from __future__ import annotations

import numpy as np

from lavendersim.geometry.rotations import products

from .momentum import BodyStates, StepMomentum
from .motion import Floats
from .points import PointsOfPose


def meeting_pose(
    points: PointsOfPose, before: BodyStates, momentum: StepMomentum, dt: float
) -> Floats | None:
    """Return the poses (bodies, 7); None where nothing meets. points: those of the state before."""
    gap = points.contacts.gap
    closing = -0.5 * (points.before[:, 0] + points.free[:, 0])
    closes = (gap > 0.0) & (closing * dt >= gap)
    if not closes.any():
        return None
    times = np.full(len(before.pose), np.inf)
    taken = gap[closes] / closing[closes]
    for body in (points.contacts.a, points.contacts.b):
        np.minimum.at(times, body[closes], taken)
    times[~np.isfinite(times)] = 0.0
    velocity = before.velocity[:, :3].copy()
    gained = (momentum.free - momentum.before)[:, :3] / (momentum.mass * dt)[:, None]
    velocity[momentum.movable] += 0.5 * times[momentum.movable, None] * gained
    pose = before.pose.copy()
    pose[:, :3] += times[:, None] * velocity
    pose[:, 3:] = turned(pose[:, 3:], times[:, None] * before.velocity[:, 3:])
    return pose


def turned(quaternions: Floats, turns: Floats) -> Floats:
    """Return quaternions (n, 4) after turns (n, 3) [rad] about axes of the world."""
    angle = np.linalg.norm(turns, axis=1)
    share = np.where(angle > 0.0, np.sin(0.5 * angle) / np.where(angle > 0.0, angle, 1.0), 0.5)
    half_turns = np.column_stack([np.cos(0.5 * angle), share[:, None] * turns])
    return products(half_turns, quaternions)
