"""The line of an ideal: a closed form evaluated at and between the cells of a series.

Between two swept values the formula is evaluated with the swept number put into the config of the
left cell. Where that does not reproduce the right cell's own value (the number moves other things
as well, such as a release height), the line goes straight from cell to cell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.figures.series import band_along
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.measures.selection import group_by
from lavendersim.measures.specs.base import ClosedForm

POINTS = 24  # per interval between two swept values


def ideal_line(
    form: ClosedForm, cells: Sequence[Cell], axis: str, path: str | None, log_x: bool
) -> tuple[Floats, Floats]:
    """Return places on the axis and the closed form there, averaged over the other axes."""
    coarse = band_along(cells, axis, lambda cell: evaluate_form(form, cell.trace().config))
    lines = (
        []
        if path is None
        else [
            _fine_line(form, group, axis, path, log_x)
            for group in group_by(cells, without=axis).values()
            if len(group) == len(coarse.places)  # others would bend the mean where they end
        ]
    )
    fine = [line for line in lines if line is not None]
    if not fine or len(fine) < len(lines):
        return coarse.places, coarse.mean
    return fine[0][0], np.mean([values for _, values in fine], axis=0)


def _fine_line(
    form: ClosedForm, cells: Sequence[Cell], axis: str, path: str, log_x: bool
) -> tuple[Floats, Floats] | None:
    """Return the line through cells that differ in this axis alone; None if it misses one."""
    ordered = sorted(cells, key=lambda cell: float(cell.coordinates[axis]))
    between = np.geomspace if log_x else np.linspace
    places: list[float] = []
    values: list[float] = []
    for left, right in pairwise(ordered):
        ends = (float(left.coordinates[axis]), float(right.coordinates[axis]))
        inside = [float(place) for place in between(*ends, POINTS)]
        found = [_patched(form, left.trace().config, path, place) for place in inside]
        known = [value for value in found if value is not None]
        target = evaluate_form(form, right.trace().config)
        if len(known) < POINTS or not math.isclose(known[-1], target, rel_tol=1e-9, abs_tol=1e-12):
            return None
        places += inside
        values += known
    return (np.array(places), np.array(values)) if places else None


def _patched(form: ClosedForm, cell: CellConfig, path: str, number: float) -> float | None:
    """Return the closed form with one number of the config replaced; None where it has no place."""
    try:
        return evaluate_form(form, _replaced(cell, path.split("."), number))
    except (KeyError, IndexError, TypeError, ValueError):
        return None


def _replaced(part: Any, path: Sequence[str], number: float) -> Any:
    """Return a part of a config with the number at a path replaced; KeyError where there is none.

    Nothing is validated: the ideal between two swept values is drawn, never run.
    """
    if not path:
        return number
    step, *rest = path
    if isinstance(part, tuple):
        place = int(step)
        return (*part[:place], _replaced(part[place], rest, number), *part[place + 1 :])
    if isinstance(part, dict):
        return part | {step: _replaced(part[step], rest, number)}
    if step not in type(part).model_fields:
        raise KeyError(step)
    return part.model_copy(update={step: _replaced(getattr(part, step), rest, number)})
