"""The measures of an experiment in its cells, each taken once and kept."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from lavendersim.errors import LavenderError, is_not_reported, unanswerable
from lavendersim.measures.interfaces import Cell, Floats, Value
from lavendersim.measures.kinds.arithmetic import derived
from lavendersim.measures.registry import beside_form, evaluate
from lavendersim.measures.specs.arithmetic import OfMeasures
from lavendersim.measures.specs.catalogue import MeasureSpec


class Values:
    """Rows of numbers by measure and cell, however many expectations and panels need them."""

    def __init__(
        self,
        measures: Mapping[str, MeasureSpec],
        taken: Mapping[int, Mapping[str, Any]] | None = None,
    ) -> None:
        """taken: by the index of a cell its measures so far; a text says why there is no number."""
        self.measures = measures
        self._taken = taken or {}
        self._rows: dict[tuple[str, int], tuple[Cell, Floats]] = {}

    def row(self, measure: str, cell: Cell) -> Floats:
        """Return the measure of one cell; a single number is a row of one."""
        known = self._taken.get(cell.index, {}).get(measure) if self._taken else None
        if isinstance(known, str):
            raise unanswerable(known) if is_not_reported(known) else LavenderError(known)
        if known is not None:
            return np.atleast_1d(np.asarray(known, dtype=np.float64))
        key = (measure, id(cell))
        if key not in self._rows:
            value = self._value(self.measures[measure], cell)
            # the cell is kept beside its row, so that no other cell can get its id
            self._rows[key] = (cell, np.atleast_1d(np.asarray(value, dtype=np.float64)))
        return self._rows[key][1]

    def _value(self, spec: MeasureSpec, cell: Cell) -> Value:
        if not isinstance(spec, OfMeasures):
            return evaluate(spec, cell.trace())
        rows = [self.row(name, cell) for name in spec.operands]
        return beside_form(spec, derived(spec, rows), cell.trace())

    def of(self, measure: str) -> Callable[[Cell], Floats]:
        """Return the function from a cell to its row of one measure."""
        return lambda cell: self.row(measure, cell)
