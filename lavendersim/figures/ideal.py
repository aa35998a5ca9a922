"""A closed form and the cells of a series in; the smooth line of the ideal out.

Between two swept values the formula is evaluated with the swept number put into the config of the
left cell. Where that does not reproduce the right cell's own value (the number moves other things
as well, such as a release height), the line goes straight from cell to cell.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from lavendersim.figures.series import band_along
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.selection import group_by
from lavendersim.measures.specs.base import ClosedForm
from lavendersim.measures.views import Cell, Floats

POINTS = 24  # per interval between two swept values


def ideal_line(
    form: ClosedForm, cells: Sequence[Cell], axis: str, path: str | None, log_x: bool
) -> tuple[Floats, Floats]:
    """Return places on the axis and the closed form there, averaged over the other axes."""
    coarse = band_along(cells, axis, lambda cell: evaluate_form(form, cell.trace().resolved))
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
        found = [_patched(form, left.trace().resolved, path, place) for place in inside]
        known = [value for value in found if value is not None]
        target = evaluate_form(form, right.trace().resolved)
        if len(known) < POINTS or not math.isclose(known[-1], target, rel_tol=1e-9, abs_tol=1e-12):
            return None
        places += inside
        values += known
    return (np.array(places), np.array(values)) if places else None


def _patched(
    form: ClosedForm, resolved: Mapping[str, Any], path: str, number: float
) -> float | None:
    """Return the closed form with one number of the config replaced; None where it has no place."""
    config = copy.deepcopy(dict(resolved))
    *steps, last = path.split(".")
    target: Any = config
    try:
        for step in steps:
            target = target[int(step)] if isinstance(target, list | tuple) else target[step]
        if isinstance(target, list):
            target[int(last)] = number
        elif last in target:
            target[last] = number
        else:
            return None
        return evaluate_form(form, config)
    except (KeyError, IndexError, TypeError, ValueError):
        return None
