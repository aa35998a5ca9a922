"""How far the steps of a cell converged, and which contact had the largest residual."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from .limits_reached import AT_LIMIT

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
        missed = self.not_converged or 0
        if self.tolerance is not None:
            missed += int(np.count_nonzero(step["not_converged"]))
        worst = step["residual"].max(initial=self.worst_residual)
        return self._replace(
            worst_residual=float(worst),
            not_converged=missed,
            worst={} if contact is None else self._worst(step, contact, names),
            at_limit=self._at_limit(step),
        )

    def _at_limit(self, step: np.ndarray) -> Mapping[str, int]:
        found = dict(self.at_limit)
        for column in AT_LIMIT:
            if column in (step.dtype.names or ()) and (count := int(step[column].sum())):
                found[column] = found.get(column, 0) + count
        return found

    def _worst(
        self, step: np.ndarray, contact: np.ndarray, names: Sequence[str]
    ) -> Mapping[str, Worst]:
        found = dict(self.worst)
        for part in PARTS:
            if f"{part}_contact" not in (step.dtype.names or ()) or len(step) == 0:
                continue
            row = step[int(step[part].argmax())]  # the first NaN, where there is one
            value, before = float(row[part]), found.get(part)
            if before is None or value > before.value or np.isnan(value):
                bodies = _pair(contact, int(row["step"]), int(row[f"{part}_contact"]), names)
                found[part] = Worst(value, bodies)
        return found


def _pair(contact: np.ndarray, step: int, index: int, names: Sequence[str]) -> str:
    """Return the names of the bodies of a step's logged contact."""
    if index < 0:
        return ""
    row = contact[contact["step"].searchsorted(step) + index]
    return f"{names[row['body_a']]} and {names[row['body_b']]}"
