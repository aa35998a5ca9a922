"""Which cells of a sweep a selection (`at: {axis: value}`) means, and their grouping by axes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any, TypeVar

from lavendersim.measures.interfaces import Cell
from lavendersim.measures.specs.selection import ANY
from lavendersim.quantities.scalars import label

SomeCell = TypeVar("SomeCell", bound=Cell)


def same(left: Any, right: Any) -> bool:
    """Tell whether two swept values are the same; numbers by value, so 1/4 is 0.25."""
    if isinstance(left, bool) or isinstance(right, bool):
        return left is right
    if isinstance(left, int | float | Fraction) and isinstance(right, int | float | Fraction):
        return float(left) == float(right)
    if isinstance(left, list | tuple) and isinstance(right, list | tuple):
        return len(left) == len(right) and all(map(same, left, right))
    return bool(left == right)


def selects(selection: Mapping[str, Any], coordinates: Mapping[str, Any]) -> bool:
    """Tell whether a cell is meant: it has every axis named, at (one of) the values named."""
    for axis, chosen in selection.items():
        if axis not in coordinates:
            return False
        if chosen == ANY:
            continue
        found = coordinates[axis]
        choices = chosen if isinstance(chosen, list | tuple) else (chosen,)
        if not (same(chosen, found) or any(same(choice, found) for choice in choices)):
            return False
    return True


def select(cells: Iterable[SomeCell], *selections: Mapping[str, Any]) -> list[SomeCell]:
    """Return the cells that every selection means, in their order."""
    return [cell for cell in cells if all(selects(one, cell.coordinates) for one in selections)]


def group_by(
    cells: Iterable[SomeCell], axes: Sequence[str] | None = None, *, without: str = ""
) -> dict[str, list[SomeCell]]:
    """Return cells grouped by their values on `axes`, or on all their axes but `without`."""
    groups: dict[str, list[SomeCell]] = {}
    for cell in cells:
        kept = [a for a in cell.coordinates if a != without and (axes is None or a in axes)]
        groups.setdefault(coordinates_text(cell.coordinates, kept), []).append(cell)
    return groups


def coordinates_text(coordinates: Mapping[str, Any], axes: Iterable[str]) -> str:
    """Return `e=0.8, timestep=1/480` for the axes named."""
    return ", ".join(f"{axis}={label(coordinates[axis])}" for axis in axes)


def distinguishing_axes(cells: Sequence[Cell], selection: Mapping[str, Any]) -> set[str]:
    """Return the axes that tell these cells apart, and those their selection names."""
    axes = {axis for cell in cells for axis in cell.coordinates}
    varied = {
        axis for axis in axes if len({label(cell.coordinates.get(axis)) for cell in cells}) > 1
    }
    return varied | (axes & set(selection))
