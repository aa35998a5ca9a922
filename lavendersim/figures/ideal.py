"""The line of an ideal: a closed form or a formula at and between the cells of a series.

Between two swept values a formula has the number there for its axis. A closed form is evaluated
with the swept number put into the config of the left cell; where that does not reproduce the right
cell's own value (the number moves other things as well, such as a release height), the line goes
straight from cell to cell.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.errors import LavenderError
from lavendersim.figures.series import band_along
from lavendersim.figures.specs.ideal import Ideal
from lavendersim.measures.cell_judgements import evaluated
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.measures.selection import group_by
from lavendersim.measures.specs.base import ClosedForm
from lavendersim.quantities.formula import FormulaError

POINTS = 24  # per interval between two swept values


def ideal_of(ideal: Ideal, cell: Cell) -> float:
    """Return an ideal in a cell; NaN where its formula has no value there."""
    if ideal.closed_form is not None:
        return evaluate_form(ideal.closed_form, cell.trace().config)
    assert ideal.value is not None
    return _value_at(ideal.value, cell.coordinates)


def _value_at(value: float | str, coordinates: Mapping[str, Any]) -> float:
    try:
        return evaluated(value, coordinates)
    except FormulaError:
        return math.nan


def ideal_line(
    ideal: Ideal, cells: Sequence[Cell], axis: str, path: str | None, log_x: bool
) -> tuple[Floats, Floats]:
    """Return places on the axis and the ideal there, averaged over the other axes.

    path: that the axis varies, where it is one.
    """
    coarse = band_along(cells, axis, lambda cell: ideal_of(ideal, cell))
    lines: list[tuple[Floats, Floats] | None] = []
    for group in group_by(cells, without=axis).values():
        if len(group) != len(coarse.places):  # it would bend the mean where it ends
            continue
        if ideal.closed_form is None:
            lines.append(_line_of_values(ideal.value, group, axis, log_x))
        elif path is not None:
            lines.append(_fine_line(ideal.closed_form, group, axis, path, log_x))
    fine = [line for line in lines if line is not None]
    if not fine or len(fine) < len(lines):
        return coarse.places, coarse.mean
    return fine[0][0], np.mean([values for _, values in fine], axis=0)


def _line_of_values(
    value: float | str | None, cells: Sequence[Cell], axis: str, log_x: bool
) -> tuple[Floats, Floats] | None:
    """Return the line of a formula through cells that differ in this axis alone."""
    assert value is not None
    ordered = sorted(cells, key=lambda cell: float(cell.coordinates[axis]))
    between = np.geomspace if log_x else np.linspace
    places = [
        float(place)
        for ends in pairwise(float(cell.coordinates[axis]) for cell in ordered)
        for place in between(*ends, POINTS)
    ]
    others = ordered[0].coordinates
    values = [_value_at(value, {**others, axis: place}) for place in places]
    return (np.array(places), np.array(values)) if places else None


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
    except (KeyError, IndexError, TypeError, ValueError, LavenderError):
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
