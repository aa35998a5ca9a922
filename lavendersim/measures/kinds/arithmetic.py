"""Measures of other measures: a ratio, a difference, a power, a number of a row."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from lavendersim.errors import LavenderError
from lavendersim.measures.interfaces import Floats
from lavendersim.measures.specs import arithmetic as specs

STATISTICS: Final[dict[str, Callable[[Floats], Any]]] = {
    "max": np.max,
    "min": np.min,
    "mean": np.mean,
    "sum": np.sum,
    "first": lambda row: row[0],
    "last": lambda row: row[-1],
}


def derived(spec: specs.OfMeasures, rows: Sequence[Floats]) -> Floats:
    """Return a measure of measures; rows: the numbers of its operands, in their order.

    LavenderError for rows of different lengths, unless one is a single number.
    """
    if isinstance(spec, specs.OfRow):
        (row,) = rows
        if not len(row):
            return np.array([np.nan])
        if np.isnan(row).any():  # also of `first`: the row is no whole one
            return np.array([np.nan])
        return np.atleast_1d(np.asarray(STATISTICS[spec.of](row), np.float64))
    if isinstance(spec, specs.Power):
        (row,) = rows
        with np.errstate(invalid="ignore", divide="ignore"):
            powers = np.power(row, spec.exponent)
        return np.where(np.isinf(powers), np.nan, powers)
    left, right = rows
    if len(left) != len(right) and 1 not in (len(left), len(right)):
        names = " and ".join(f"{n} has {len(r)}" for n, r in zip(spec.operands, rows, strict=True))
        raise LavenderError(f"a measure of rows of different lengths: {names} numbers")
    if isinstance(spec, specs.Ratio):
        by = np.where(right == 0.0, np.nan, right)
        return np.asarray(left / by, np.float64)
    return np.asarray(left - right, np.float64)
