"""Balls on a vertical line that fall and strike each other and a floor, event by event.

Between impacts x + v t - g t^2/2, the same for all: gaps of neighbours close linearly, the one to
the floor by the quadratic's root.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

FLOOR = -1  # its number among partners


class Line(NamedTuple):
    """Balls from the lowest to the highest: masses [kg], radii [m], restitution, gravity [m/s^2].

    floor: whether there is one at 0.
    """

    masses: np.ndarray
    radii: np.ndarray
    restitution: float = 1.0
    gravity: float = 0.0
    floor: bool = False

    def after(
        self, seconds: float, place: np.ndarray, velocity: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return places and velocities."""
        x, v, left = np.array(place, dtype=float), np.array(velocity, dtype=float), seconds
        while True:
            when, lower = self._next(x, v)
            step = min(when, left)
            x += v * step - 0.5 * self.gravity * step**2
            v -= self.gravity * step
            left -= step
            if when > step or left <= 0.0:
                return x, v
            self._strike(v, lower)

    def _next(self, x: np.ndarray, v: np.ndarray) -> tuple[float, int]:
        gaps = x[1:] - x[:-1] - self.radii[1:] - self.radii[:-1]
        closing = v[:-1] - v[1:]
        times = [
            (max(gap, 0.0) / rate, k)
            for k, (gap, rate) in enumerate(zip(gaps, closing, strict=True))
            if rate > 1e-13
        ]
        if self.floor and self.gravity > 0.0:
            gap = max(x[0] - self.radii[0], 0.0)
            if gap > 0.0 or v[0] < 0.0:
                root = math.sqrt(v[0] ** 2 + 2.0 * self.gravity * gap)
                times.append(((v[0] + root) / self.gravity, FLOOR))
            else:
                times.append((2.0 * v[0] / self.gravity, FLOOR))
        return min(times, default=(math.inf, 0))

    def _strike(self, v: np.ndarray, lower: int) -> None:
        if lower == FLOOR:
            v[0] = -self.restitution * v[0]
            return
        one, two = self.masses[lower], self.masses[lower + 1]
        impulse = (1.0 + self.restitution) * (v[lower] - v[lower + 1]) * one * two / (one + two)
        v[lower] -= impulse / one
        v[lower + 1] += impulse / two
