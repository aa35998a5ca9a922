"""The spread of repeated timings: median, quartiles, and an interval that holds the true median.

The interval is that of the sign test, between two of the ordered samples, whatever their
distribution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import comb
from typing import Final

import numpy as np

OUTSIDE: Final = 0.025  # largest probability that the median lies beyond either end of the interval


@dataclass(frozen=True)
class Spread:
    """Some samples in five numbers; low and high hold their true median in 19 of 20 cases."""

    median: float
    lower_quartile: float
    upper_quartile: float
    low: float
    high: float

    @classmethod
    def of(cls, samples: Sequence[float]) -> Spread:
        """Return the spread of samples."""
        ordered = np.sort(np.asarray(samples, dtype=np.float64))
        beyond = samples_beyond(len(ordered))
        middle, lower, upper = np.quantile(ordered, [0.5, 0.25, 0.75]).tolist()
        return cls(middle, lower, upper, float(ordered[beyond]), float(ordered[-1 - beyond]))

    @property
    def width(self) -> float:
        """How long the interval is."""
        return self.high - self.low

    def per(self, units: float) -> Spread:
        """Return the spread of one unit."""
        return Spread(**{name: value / units for name, value in asdict(self).items()})


def samples_beyond(count: int) -> int:
    """Return how many samples may be left out at either end of an interval for the median.

    At most k of n samples lie below the median with probability sum_(i<=k) C(n, i) / 2^n, whatever
    their distribution; with fewer than six samples even all of them hold it less often than asked.
    """
    beyond, below = 0, 0.0
    for k in range(count):
        below += comb(count, k) / 2**count
        if below > OUTSIDE:
            break
        beyond = k
    return beyond
