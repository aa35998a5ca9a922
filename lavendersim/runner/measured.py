"""The measures and the checks of `always` of a cell, taken from its log as soon as it has ended."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from lavendersim.errors import LavenderError
from lavendersim.measures import Values, applies
from lavendersim.measures.always import WorstStates
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.verdict import Outcome

from .run_directory import RunCell


class Measured(NamedTuple):
    """What was taken from the log of one cell."""

    values: dict[str, Any]  # measure -> number, list, or a text saying why there is none
    always: dict[str, Outcome]  # by the checks of `always`; none without that section


def measure_cell(
    cell: RunCell, measures: Mapping[str, MeasureSpec], worst: WorstStates | None
) -> Measured:
    """Take every measure of a cell, once; worst: its states by the checks of `always`."""
    values = Values(measures)
    measured: dict[str, Any] = {}
    for name, spec in measures.items():
        if not applies(spec, cell.coordinates):
            continue
        try:
            row = values.row(name, cell).tolist()
        except LavenderError as error:
            measured[name] = str(error)
            continue
        measured[name] = row[0] if len(row) == 1 else row
    return Measured(measured, {} if worst is None else worst.outcomes(cell.status, cell))
