"""The series of a panel: cells that are drawn alike, their mean and their range."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from lavendersim.figures.style import MOST_MARKED, Look, look, sequential
from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.quantities.scalars import label


class Series(NamedTuple):
    """Cells that are drawn alike."""

    label: str
    cells: list[Cell]
    number: float | None = None  # the value of the axis that splits them, where it is a number


class Band(NamedTuple):
    """One point per place: the mean of several cells, and how far they spread."""

    places: Floats
    mean: Floats
    low: Floats
    high: Floats

    @property
    def spread(self) -> bool:
        """True when the cells at some place differ visibly (more than round-off)."""
        return bool(np.any(self.high - self.low > 1e-9 * np.maximum(1e-300, np.abs(self.high))))


def series_of(cells: Sequence[Cell], axis: str | None, label: str = "") -> list[Series]:
    """Return the cells split by an axis, in the order of the sweep; one series without an axis.

    label: the legend entry with {} for the value; `axis = value` when empty.
    """
    if axis is None:
        return [Series("measured", list(cells))] if cells else []
    template = label or axis.replace("_", " ") + " = {}"
    split = by_value([cell for cell in cells if axis in cell.coordinates], axis)
    return [
        # Names of solvers are read, not typed, in a figure.
        Series(
            template.replace("{}", value.replace("_", " ")) + _mark(members),
            members,
            _number(members[0].coordinates[axis]),
        )
        for value, members in split.items()
    ]


def axis_of(cells: Sequence[Cell]) -> str | None:
    """Return the axis by which cells differ; None where there is none, or more than one."""
    axes = dict.fromkeys(axis for cell in cells for axis in cell.coordinates)
    if any(axis not in cell.coordinates for cell in cells for axis in axes):
        return None
    differing = [axis for axis in axes if len(by_value(cells, axis)) > 1]
    return differing[0] if len(differing) == 1 else None


def _number(value: object) -> float | None:
    is_number = isinstance(value, int | float | Fraction) and not isinstance(value, bool)
    return float(value) if is_number else None  # type: ignore[arg-type]


def looks_of(all_series: Sequence[Series]) -> list[Look]:
    """Return how each series is drawn: many numbers as lines of a sequential scale, by their rank.

    Up to five series, and those of names, have a colour and a marker each.
    """
    numbers = [one.number for one in all_series if one.number is not None]
    if len(all_series) <= MOST_MARKED or len(numbers) < len(all_series):
        return [look(index) for index in range(len(all_series))]
    ordered = sorted(numbers)
    return [sequential(ordered.index(number), len(ordered)) for number in numbers]


def _mark(cells: Sequence[Cell]) -> str:
    """Return what an entry of a legend ends with where a log of its cells is damaged."""
    allowed = [cell for cell in cells if getattr(cell, "allow_incomplete", False)]
    return " (incomplete)" if any(getattr(cell, "damage", str)() for cell in allowed) else ""


def by_value(cells: Sequence[Cell], axis: str) -> dict[str, list[Cell]]:
    """Return cells by the written value of an axis that all of them have, in their order."""
    split: dict[str, list[Cell]] = {}
    for cell in cells:
        split.setdefault(label(cell.coordinates[axis]), []).append(cell)
    return split


def band_along(
    cells: Sequence[Cell], axis: str, number_of: Callable[[Cell], float], factor: float = 1.0
) -> Band:
    """Return a number of each cell against a swept axis, in rising order of the axis."""
    stations: dict[float, list[float]] = {}
    for cell in cells:
        station = stations.setdefault(float(cell.coordinates[axis]), [])
        station.append(factor * number_of(cell))
    places = sorted(stations)
    columns = [[f(stations[place]) for place in places] for f in (np.mean, np.min, np.max)]
    return Band(np.array(places), *(np.array(column, dtype=np.float64) for column in columns))


def band_of_rows(rows: Sequence[Floats], first_index: int, factor: float = 1.0) -> Band:
    """Return rows of numbers against their index; longer rows are cut to the shortest."""
    length = min(len(row) for row in rows)
    table = factor * np.stack([row[:length] for row in rows])
    places = np.arange(first_index, first_index + length, dtype=np.float64)
    return Band(places, table.mean(axis=0), table.min(axis=0), table.max(axis=0))


def swept_path(experiment: Any, axis: str) -> str | None:
    """Return the config path that an axis varies."""
    sweep = experiment.config.sweep
    for product in (sweep,) if isinstance(sweep, dict) else sweep:
        if axis in product:
            return str(product[axis].every_path[0])
    return None


def within(window: tuple[float, float] | None, time: Floats) -> Any:
    """Return which times [s] a panel shows, as a mask; all without a window."""
    if window is None:
        return np.ones(len(time), dtype=bool)
    return (time >= window[0]) & (time <= window[1])
