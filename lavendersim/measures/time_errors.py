"""The error that the timestep leaves in a number, from the same number at h, h/2 and h/4.

What a method of order p computes at timestep h is f(h) = f + C h^p + smaller terms. Three values
give the three unknowns (Richardson's extrapolation):

    p = log2((f(h) - f(h/2)) / (f(h/2) - f(h/4)))
    f = f(h/4) + (f(h/4) - f(h/2)) / (2^p - 1)

where the differences shrink and keep their sign. Where they do not, the number is not yet in the
range in which its error is a power of h, and only how far the three lie apart can be said.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, log2, nan
from typing import NamedTuple

import numpy as np

# Differences below this share of the number are the solver's: a step is solved to 1e-9.
SOLVED = 1e-9
ROUND_OFF = 1e-13  # some hundred operations on numbers of size one
# No integrator here is of a higher order: what looks so is a coincidence of three numbers.
HIGHEST_ORDER = 2.0
DIVISORS = (1, 2, 4)


class TimeError(NamedTuple):
    """How a number changes as the timestep shrinks."""

    values: tuple[float, ...]  # at h, h/2, h/4
    change: float  # from h to h/2
    order: float  # NaN where no power of h fits, or nothing changes
    extrapolated: float  # to h = 0
    bar: float  # half the width within which that is trusted
    note: str = ""  # why there is no order, or no estimate at all

    @property
    def error(self) -> float:
        """What the timestep adds to the number at h, by the extrapolation."""
        return self.values[0] - self.extrapolated if self.values else nan


def time_error(coarse: float, half: float, quarter: float) -> TimeError:
    """Return the estimate from a number at h, h/2 and h/4."""
    values = (coarse, half, quarter)
    first, second = half - coarse, quarter - half
    spread = max(abs(first), abs(second), abs(quarter - coarse))
    if not all(isfinite(value) for value in values):
        return TimeError(values, first, nan, nan, nan, "not a number at every timestep")
    if spread <= max(SOLVED * max(abs(value) for value in values), ROUND_OFF):
        return TimeError(values, first, nan, quarter, spread, "equal as far as a step is solved")
    if first * second > 0.0 and abs(first) > abs(second):
        order = log2(first / second)
        # The bar is what is left at h/4, by a power that is not overrated.
        rest = second / (2.0 ** min(order, HIGHEST_ORDER) - 1.0)
        return TimeError(values, first, order, quarter + rest, abs(rest))
    note = "the changes do not shrink" if first * second >= 0.0 else "the changes alternate"
    return TimeError(values, first, nan, quarter, spread, note)


def time_error_of(rows: Sequence[object]) -> TimeError:
    """Return the estimate for a measure at h, h/2 and h/4; of a row of numbers, the worst change.

    rows: a number, a list of numbers, or a text that says why there is none.
    """
    texts = [row for row in rows if isinstance(row, str)]
    if texts:
        return TimeError((), nan, nan, nan, nan, texts[0])
    numbers = [np.atleast_1d(np.asarray(row, dtype=np.float64)) for row in rows]
    lengths = [len(row) for row in numbers]
    if len(set(lengths)) > 1:
        counts = ", ".join(map(str, lengths))
        return TimeError((), nan, nan, nan, nan, f"rows of {counts} numbers")
    if lengths[0] == 0:
        return TimeError((), nan, nan, nan, nan, "rows without a number")
    change = np.abs(numbers[1] - numbers[0])
    worst = int(np.argmax(np.where(np.isnan(change), np.inf, change)))
    return time_error(*(float(row[worst]) for row in numbers))
