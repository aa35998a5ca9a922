"""How far an axis can go before a bound breaks, over two other axes: a heat map with its numbers.

A limit is found from the safe end of the axis: the largest timestep up to which every smaller one
holds, too. What holds beyond a failure by luck does not count. A cell that diverged, or whose
measure is not a number, holds nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Rectangle

from lavendersim.figures.registration import draws
from lavendersim.figures.series import by_value
from lavendersim.figures.specs.stability_map import StabilityMap
from lavendersim.figures.style import DARK, GREY
from lavendersim.measures.always import COMPLETE
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.values import Values
from lavendersim.quantities.scalars import label

COLOURS: Final = "cividis"  # distinguished by colour-blind readers and in grey
HALF_DARK: Final = 0.5  # luminance below which letters are white [-]


@draws(StabilityMap)
def draw_panel(
    axes: Any, panel: StabilityMap, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    named = (panel.axis, panel.rows, panel.of)
    shown = [cell for cell in cells if all(axis in cell.coordinates for axis in named)]
    columns, rows = (list(by_value(shown, axis)) for axis in named[:2])
    found = limits(panel, shown, lambda cell: _holds(panel, cell, values))
    numbers = [float(limit) for limit in found.values() if limit is not None]
    colour = _colours(numbers)
    for (column, row), limit in found.items():
        x, y = columns.index(column), rows.index(row)
        if limit is None:
            axes.add_patch(_tile(x, y, facecolor="white", edgecolor=GREY, hatch="////"))
            axes.text(x, y, "none", ha="center", va="center", backgroundcolor="white")
            continue
        face = colour(float(limit))
        luminance = float(np.dot(face[:3], (0.2126, 0.7152, 0.0722)))
        axes.add_patch(_tile(x, y, facecolor=face, edgecolor="white"))
        letters = "white" if luminance < HALF_DARK else DARK
        axes.text(x, y, label(limit), ha="center", va="center", color=letters)
    _mark(axes, panel, columns, rows)
    axes.grid(False)
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(-0.5, len(rows) - 0.5)
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), [row.replace("_", " ") for row in rows])


def limits(
    panel: StabilityMap, cells: Sequence[Cell], holds: Callable[[Cell], bool]
) -> dict[tuple[str, str], Any]:
    """Return the limit of `panel.of` for every pair of written values; None where none holds."""
    found: dict[tuple[str, str], Any] = {}
    for column, standing in by_value(cells, panel.axis).items():
        for row, members in by_value(standing, panel.rows).items():
            steps = sorted(
                by_value(members, panel.of).values(),
                key=lambda group: float(group[0].coordinates[panel.of]),
                reverse=panel.find == "least",
            )
            found[column, row] = None
            for group in steps:
                if not all(map(holds, group)):
                    break
                found[column, row] = group[0].coordinates[panel.of]
    return found


def _holds(panel: StabilityMap, cell: Cell, values: Values) -> bool:
    if cell.trace().status != COMPLETE:
        return False
    # NaN <= bound is false, as it must be.
    return bool(np.all(values.row(panel.measure, cell) <= panel.at_most))


def _colours(numbers: Sequence[float]) -> Callable[[float], Any]:
    low, high = (min(numbers), max(numbers)) if numbers else (1.0, 1.0)
    norm = LogNorm(low, high) if 0.0 < low < high else Normalize(low, high)
    scheme = colormaps[COLOURS]
    # The darkest and the lightest tenth are left to frames and letters.
    return lambda number: scheme(0.1 + 0.8 * float(norm(number)))


def _tile(x: int, y: int, **drawn: Any) -> Rectangle:
    return Rectangle((x - 0.5, y - 0.5), 1.0, 1.0, linewidth=1.0, **drawn)


def _mark(axes: Any, panel: StabilityMap, columns: list[str], rows: list[str]) -> None:
    """Frame the default: a tile, or the whole column or row where only one of them is named."""
    if not panel.default:
        return
    column, row = (panel.default.get(axis) for axis in (panel.axis, panel.rows))
    x = columns.index(label(column)) if column is not None else 0
    y = rows.index(label(row)) if row is not None else 0
    width = 1 if column is not None else len(columns)
    height = 1 if row is not None else len(rows)
    axes.add_patch(
        Rectangle(
            (x - 0.5, y - 0.5),
            width,
            height,
            fill=False,
            edgecolor="#D55E00",
            linewidth=2.6,
            zorder=4,
            clip_on=False,
        )
    )
