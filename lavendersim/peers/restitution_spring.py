"""A coefficient of restitution as an underdamped spring, for an engine that has no other.

A free half swing of x'' + 2 zeta w x' + w^2 x = 0 leaves e = exp(-pi zeta / sqrt(1 - zeta^2)) of
the speed that it began with, and takes pi / (w sqrt(1 - zeta^2)).
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

# Steps of a half swing. Shorter ones are resolved worse by an engine's integrator.
SWING_STEPS: Final = 12


def spring_of(restitution: float, timestep: float) -> tuple[float, float]:
    """Return -w^2 [1/s^2] and -2 zeta w [1/s], per mass, for 0 < e <= 1; MuJoCo takes both so."""
    decay = -log(restitution) / pi  # zeta / sqrt(1 - zeta^2)
    zeta = decay / sqrt(1.0 + decay * decay)
    natural = pi / (SWING_STEPS * timestep * sqrt(1.0 - zeta * zeta))
    return -natural * natural, -2.0 * zeta * natural


def restitutions(references: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the restitution that rows of -w^2, -2 zeta w stand for; 0 of rows that are neither."""
    found = np.zeros(len(references))
    for row, (stiffness, damping) in enumerate(-references):
        if stiffness > 0.0:
            zeta = 0.5 * damping / sqrt(stiffness)
            found[row] = exp(-pi * zeta / sqrt(1.0 - zeta * zeta))
    return found
