"""Resolving gravity: a vector, of a number, a vector or a tilt as written."""

from __future__ import annotations

import math

from lavendersim.experiment.models.gravity import TiltedGravity
from lavendersim.quantities.quantity import Vector3


def gravity_vector(gravity: float | Vector3 | TiltedGravity) -> Vector3:
    """Return gravity [m/s^2]; a number is its magnitude along -z."""
    if isinstance(gravity, tuple):
        return gravity
    if not isinstance(gravity, TiltedGravity):
        return (0.0, 0.0, 0.0 - gravity)
    if gravity.slope is not None:
        down = 1.0 / math.hypot(1.0, gravity.slope)
        along = gravity.slope * down
    else:
        angle = math.radians(gravity.tilt_degrees or 0.0)
        down, along = math.cos(angle), math.sin(angle)
    azimuth = math.radians(gravity.azimuth_degrees)
    x, y = along * math.cos(azimuth), along * math.sin(azimuth)
    return (gravity.magnitude * x, gravity.magnitude * y, -gravity.magnitude * down)
