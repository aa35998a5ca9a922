"""A closed form and the cells of a series in; the smooth line of the ideal out.

Between two swept values the formula is evaluated with the swept number put into the config of the
left cell. Where that does not reproduce the right cell's own value (the number moves other things
as well, such as a release height), the line goes straight from cell to cell.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from lavendersim.experiment.measure_specs import ClosedForm
from lavendersim.figures.series import band_along
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.views import Cell, Floats

POINTS = 24  # per interval between two swept values


def ideal_line(
    form: ClosedForm, cells: Sequence[Cell], axis: str, path: str | None, log_x: bool
) -> tuple[Floats, Floats]:
    """Return places on the axis and the closed form there, averaged over the other axes."""
    coarse = band_along(cells, axis, lambda cell: evaluate_form(form, cell.trace().resolved))
    if path is None or coarse.spread or len(coarse.places) < 2:
        return coarse.places, coarse.mean
    ordered = sorted(cells, key=lambda cell: float(cell.coordinates[axis]))
    resolved = {float(cell.coordinates[axis]): cell.trace().resolved for cell in ordered}
    places: list[float] = []
    values: list[float] = []
    for left, right, target in zip(
        coarse.places[:-1], coarse.places[1:], coarse.mean[1:], strict=True
    ):
        config = resolved[float(left)]
        reached = _patched(form, config, path, float(right))
        if reached is None or not math.isclose(reached, target, rel_tol=1e-9, abs_tol=1e-12):
            return coarse.places, coarse.mean
        between = np.geomspace if log_x else np.linspace
        for place in between(left, right, POINTS):
            places.append(float(place))
            values.append(_patched(form, config, path, float(place)) or 0.0)
    return np.array(places), np.array(values)


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
