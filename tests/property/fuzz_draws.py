"""Choices for random configs, each from a seed of its own: the same on every machine and release.

Shares are multiples of 2^-24 (numbers of a file stay short), and often an edge, where defects are.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

EDGE = 0.125  # of shares: how many are 0 or 1
STEPS = 24  # bits of a share


class Draw:
    """Draws numbers, from a text that says which."""

    def __init__(self, seed: str) -> None:
        self._random = random.Random(seed)

    def integer(self, low: int, high: int) -> int:
        """Return a whole number of both ends and between."""
        return self._random.randint(low, high)

    def one_of(self, values: Sequence[Any]) -> Any:
        """Return one of these."""
        return values[self._random.randrange(len(values))]

    def some_of(self, values: Sequence[Any], most: int) -> list[Any]:
        """Return at least one of these and at most so many, each once, in their order."""
        chosen = self._random.sample(range(len(values)), self.integer(1, most))
        return [values[k] for k in sorted(chosen)]

    def coin(self) -> bool:
        """Return either."""
        return bool(self._random.getrandbits(1))

    def share(self, low: float = 0.0) -> float:
        """Return something from `low` to 1, both included."""
        edge = self._random.random()
        if edge < EDGE:
            return low if edge < 0.5 * EDGE else 1.0
        return low + (1.0 - low) * self._random.getrandbits(STEPS) / 2.0**STEPS

    def unit(self) -> float:
        """Return something from -1 to 1; one in sixteen is 0."""
        if self.integer(0, 15) == 0:
            return 0.0
        return 2.0 * self.share() - 1.0

    def power(self, low: float, high: float) -> float:
        """Return ten to the power of something between."""
        return float(10.0 ** (low + (high - low) * self.share()))

    def signed(self, low: float, high: float) -> float:
        """Return a power of ten of either sign."""
        return self.power(low, high) * (1.0 if self.coin() else -1.0)

    def vector(self, size: float) -> list[float]:
        """Return a vector no longer than sqrt(3) sizes."""
        return [size * self.unit() for _ in range(3)]

    def some_vector(self, low: float, high: float) -> list[float]:
        """Return a vector that is not zero."""
        made = self.vector(self.power(low, high))
        return made if any(made) else [10.0**low, 0.0, 0.0]
