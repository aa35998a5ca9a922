"""Judgements of a measure across cells: trends, ratios, orders of convergence, crossings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from lavendersim.measures.interfaces import Cell, Floats
from lavendersim.measures.selection import group_by, select
from lavendersim.measures.specs.expectation import Crosses, ExpectSpec, Order, Ratio
from lavendersim.measures.verdict import NO_TOLERANCE, Outcome, failure
from lavendersim.quantities.scalars import label

REDUCTIONS: Final[Mapping[str, Callable[..., Floats]]] = {
    "max": np.max,  # np.max, not np.nanmax: one NaN spoils the group, and so it must
    "min": np.min,
    "mean": np.mean,
}
RowOf = Callable[[Cell], Floats]  # the measure of a cell as a row of numbers


def judge_sweep(expectation: ExpectSpec, cells: Sequence[Cell], row_of: RowOf) -> Outcome:
    """Return the outcome of an expectation across the cells it selects."""
    if expectation.ratio is not None:
        return _ratio(expectation.ratio, cells, row_of)
    if expectation.crosses is not None:
        return _crosses(expectation.crosses, cells, row_of)
    if expectation.order is not None:
        return _order(expectation.order, cells, row_of)
    return _trend(expectation, cells, row_of)


def reduced(cells: Sequence[Cell], row_of: RowOf, how: str) -> Floats:
    """Return one row for several cells, number by number; rows must be equally long."""
    rows = [row_of(cell) for cell in cells]
    if len({len(row) for row in rows}) != 1:
        return np.array([np.nan])
    return np.atleast_1d(REDUCTIONS[how](np.stack(rows), axis=0))


def first_rise(places: Sequence[float], heights: Sequence[float], level: float) -> float:
    """Return where a polyline first rises through a level; NaN when it never does."""
    for index in range(1, len(places)):
        low, high = heights[index - 1], heights[index]
        if low < level <= high:
            share = (level - low) / (high - low)
            return places[index - 1] + share * (places[index] - places[index - 1])
    return float("nan")


def along_axis(
    cells: Sequence[Cell], row_of: RowOf, axis: str, how: str
) -> tuple[list[float], list[float]]:
    """Return the values of an axis in rising order and the reduced measure at each."""
    stations: dict[float, list[Cell]] = {}
    for cell in cells:
        if axis in cell.coordinates:
            stations.setdefault(float(cell.coordinates[axis]), []).append(cell)
    places = sorted(stations)
    return places, [float(reduced(stations[place], row_of, how)[0]) for place in places]


def _trend(expectation: ExpectSpec, cells: Sequence[Cell], row_of: RowOf) -> Outcome:
    trend = expectation.increasing or expectation.decreasing
    assert trend is not None
    axis, sign = trend.along, 1.0 if expectation.increasing else -1.0
    expected = f"strictly {expectation.judgement} along {axis}"
    along = [cell for cell in cells if axis in cell.coordinates]
    if not along:
        return failure(expected, f"no selected cell has the axis {axis}")
    closest, reason = float("inf"), ""
    for group, members in group_by(along, without=axis).items():
        members = sorted(members, key=lambda cell: float(cell.coordinates[axis]))
        if len(members) < 2:
            return failure(expected, f"only one value of {axis} at {group}")
        for before, after in pairwise(members):
            low, high = row_of(before), row_of(after)
            if len(low) != len(high):
                return failure(expected, "the rows are not equally long")
            rise = float(np.min(sign * (high - low)))
            if not rise > 0.0 and not reason:
                reason = (
                    f"{_numbers(high)} at {axis}={label(after.coordinates[axis])} after "
                    f"{_numbers(low)} at {axis}={label(before.coordinates[axis])}"
                    + (f" ({group})" if group else "")
                )
                closest = rise
            elif not reason:
                closest = min(closest, rise)
    tolerance = "the least move from one value to the next, above 0 in the claimed direction"
    return Outcome(not reason, closest, expected, tolerance, reason)


def _numbers(row: Floats) -> str:
    return repr(float(row[0])) if len(row) == 1 else str(row.tolist())


def _ratio(spec: Ratio, cells: Sequence[Cell], row_of: RowOf) -> Outcome:
    bounds = [f"at most {spec.at_most!r}"] if spec.at_most is not None else []
    bounds += [f"at least {spec.at_least!r}"] if spec.at_least is not None else []
    expected = f"{spec.reduce} ratio {' and '.join(bounds)}"
    if spec.negligible:
        expected += f", or a numerator of at most {spec.negligible:g}"
    tolerance = f"numbers up to {spec.floor:g} are round-off" if spec.floor else NO_TOLERANCE
    tops = group_by(select(cells, spec.of), spec.each)
    bottoms = group_by(select(cells, spec.to), spec.each)
    if not tops or set(tops) != set(bottoms):
        return failure(expected, "`of` and `to` do not select the same groups of cells")
    worst, worst_margin, reason = float("nan"), float("inf"), ""
    for group in tops:
        top = reduced(tops[group], row_of, spec.reduce)
        bottom = reduced(bottoms[group], row_of, spec.reduce)
        if len(top) != len(bottom) or np.isnan(top).any() or np.isnan(bottom).any():
            return failure(expected, f"not a number, or rows of unequal length {group}".strip())
        above = (np.abs(top) > spec.floor) | (np.abs(bottom) > spec.floor)
        counted = np.flatnonzero(above | (spec.negligible > 0.0))
        if len(counted) == 0:
            return failure(expected, f"every number is round-off or 0 {group}".strip())
        for index in counted:
            ratio = float(top[index] / bottom[index]) if bottom[index] else float("inf")
            small = spec.negligible > 0.0 and abs(top[index]) <= spec.negligible
            margin = 0.0 if small else _margin(spec, ratio)
            if margin < worst_margin:
                worst, worst_margin = ratio, margin
                place = [group] if group else []
                place += [f"number {index} of the row"] if len(top) > 1 else []
                reason = f"{float(top[index])!r} to {float(bottom[index])!r}" + (
                    f" ({', '.join(place)})" if place else ""
                )
    return Outcome(worst_margin >= 0.0, worst, expected, tolerance, reason)


def _order(spec: Order, cells: Sequence[Cell], row_of: RowOf) -> Outcome:
    expected = f"order of at least {spec.at_least!r} along {spec.along}"
    expected += f" and at most {spec.at_most!r}" if spec.at_most is not None else ""
    expected += f", or numbers of at most {spec.negligible:g}" if spec.negligible else ""
    places, numbers = along_axis(cells, row_of, spec.along, spec.reduce)
    if len(places) < 2:
        return failure(expected, f"fewer than 2 values of {spec.along}")
    if all(abs(number) <= spec.negligible for number in numbers):
        return Outcome(True, float("inf"), expected, NO_TOLERANCE)
    if not (min(places) > 0.0 and all(0.0 < number < float("inf") for number in numbers)):
        return failure(expected, f"no logarithm of {numbers} at {places}")
    slope = float(np.polyfit(np.log(places), np.log(numbers), 1)[0])
    passed = slope >= spec.at_least and (spec.at_most is None or slope <= spec.at_most)
    return Outcome(passed, slope, expected, NO_TOLERANCE, f"{numbers} at {places}")


def _margin(spec: Ratio, ratio: float) -> float:
    """How far inside its bounds a ratio lies; negative outside."""
    margins = [spec.at_most - ratio] if spec.at_most is not None else []
    margins += [ratio - spec.at_least] if spec.at_least is not None else []
    return min(margins)


def _crosses(spec: Crosses, cells: Sequence[Cell], row_of: RowOf) -> Outcome:
    low, high = spec.between
    expected = f"rises through {spec.level!r} at {spec.along} between {low!r} and {high!r}"
    places, heights = along_axis(cells, row_of, spec.along, spec.reduce)
    place = first_rise(places, heights, spec.level)
    passed = bool(np.all(np.isfinite(heights))) and low <= place <= high
    reason = "" if place == place else f"it runs from {heights[:1]} to {heights[-1:]}"
    return Outcome(passed, place, expected, NO_TOLERANCE, reason)
