"""How far the steps of a cell converged, and which contact had the largest residual."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import isnan
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np

from .limits_reached import AT_LIMIT

NOT_CONVERGED: Final = "not_converged"
# Of what /step has the largest value, and the logged contact that has it.
PARTS: Final = ("residual", "signorini", "cone", "dissipation")


class Worst(NamedTuple):
    """The largest number of a kind in any step."""

    value: float = 0.0  # [m/s], of `cone` [N s], of `dissipation` [J]
    bodies: str = ""  # "floor and ball"; nothing where the contact is not logged


class Accuracy(NamedTuple):
    """How far the steps of a cell converged, and how far they keep the law of contact."""

    worst_residual: float = 0.0  # [m/s] of any step
    tolerance: float | None = None  # [m/s] of the config; None: every step takes all its sweeps
    # Steps whose solve ended above the tolerance; None: of another engine, which tells no residual.
    not_converged: int | None = 0
    worst: Mapping[str, Worst] = MappingProxyType({})  # by PARTS, those that the log has
    # By AT_LIMIT: how often each took all its iterations; those that never did are missing.
    at_limit: Mapping[str, int] = MappingProxyType({})

    def after(
        self, step: np.ndarray, contact: np.ndarray | None = None, names: Sequence[str] = ()
    ) -> Accuracy:
        """Return the accuracy with more rows of steps counted in; a NaN stays the worst.

        contact: rows of their contacts, names: of the bodies that these speak of.
        """
        from .largest_kernel import largest_of  # late: runs are listed without numba

        worst = {} if contact is None else dict(self.worst)
        limits = dict(self.at_limit)
        if len(step) == 0:
            return self._replace(worst=worst, at_limit=limits)
        parts, counted = _columns(step.dtype)
        found = largest_of(step, ("residual", *parts), counted)
        missed = self.not_converged or 0
        if self.tolerance is not None:
            missed += found.steps[counted.index(NOT_CONVERGED)]
        residual = float(step["residual"][found.rows[0]])
        for part, row in zip(parts, found.rows[1:], strict=True):
            if contact is None:
                break
            value, before = float(step[part][row]), worst.get(part)
            if before is None or value > before.value or isnan(value):
                at = int(step["step"][row]), int(step[f"{part}_contact"][row])
                worst[part] = Worst(value, _pair(contact, *at, names))
        for column, count in zip(counted, found.sums, strict=True):
            if column in AT_LIMIT and count:
                limits[column] = limits.get(column, 0) + count
        if not (residual > self.worst_residual or isnan(residual)):
            residual = self.worst_residual
        return self._replace(
            worst_residual=residual, not_converged=missed, worst=worst, at_limit=limits
        )


@lru_cache(maxsize=64)
def _columns(row: np.dtype[Any]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return which of PARTS rows of steps have, and which columns that count."""
    names = row.names or ()
    parts = tuple(part for part in PARTS if f"{part}_contact" in names)
    return parts, tuple(name for name in (NOT_CONVERGED, *AT_LIMIT) if name in names)


def _pair(contact: np.ndarray, step: int, index: int, names: Sequence[str]) -> str:
    """Return the names of the bodies of a step's logged contact."""
    if index < 0:
        return ""
    row = contact[contact["step"].searchsorted(step) + index]
    return f"{names[row['body_a']]} and {names[row['body_b']]}"
