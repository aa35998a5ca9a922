"""A measure over two axes of the sweep as coloured tiles with a bar of the colours beside them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Rectangle

from lavendersim.figures.panels.stability_map import COLOURS, HALF_DARK
from lavendersim.figures.registration import draws
from lavendersim.figures.series import by_value
from lavendersim.figures.specs.heat_map import HeatMap
from lavendersim.figures.style import DARK, GREY
from lavendersim.measures.interfaces import Cell
from lavendersim.measures.values import Values

MOST_NUMBERED: Final = 8  # values of an axis beyond which tiles have no room for their numbers
MOST_TICKS: Final = 12
REDUCTIONS: Final[dict[str, Callable[..., Any]]] = {"max": np.max, "min": np.min, "mean": np.mean}


@draws(HeatMap)
def draw_panel(
    axes: Any, panel: HeatMap, cells: Sequence[Cell], values: Values, experiment: Any
) -> None:
    """Draw one panel onto the axes."""
    shown = [c for c in cells if panel.axis in c.coordinates and panel.rows in c.coordinates]
    columns, rows = ([*_sorted(by_value(shown, axis), axis)] for axis in (panel.axis, panel.rows))
    table = table_of(panel, shown, columns, rows, values)
    known = table[np.isfinite(table)]
    if panel.colour_scale == "log":
        known = known[known > 0.0]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    norm = (LogNorm if panel.colour_scale == "log" and len(known) else Normalize)(low, high)
    colour = ScalarMappable(norm, COLOURS)
    numbered = max(len(columns), len(rows)) <= MOST_NUMBERED
    for (y, x), number in np.ndenumerate(table):
        corner = (x - 0.5, y - 0.5)
        if not np.isfinite(number) or (panel.colour_scale == "log" and number <= 0.0):
            tile = Rectangle(corner, 1, 1, facecolor="white", edgecolor=GREY, hatch="////")
            axes.add_patch(tile)
            continue
        face = colour.to_rgba(number)
        axes.add_patch(Rectangle(corner, 1, 1, facecolor=face, edgecolor="white", linewidth=0.5))
        if numbered:
            luminance = float(np.dot(face[:3], (0.2126, 0.7152, 0.0722)))
            letters = "white" if luminance < HALF_DARK else DARK
            axes.text(x, y, f"{number:.3g}", ha="center", va="center", color=letters, fontsize=10)
    axes.grid(False)
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(-0.5, len(rows) - 0.5)
    for names, set_ticks in ((columns, axes.set_xticks), (rows, axes.set_yticks)):
        every = 1 + (len(names) - 1) // MOST_TICKS
        set_ticks(range(0, len(names), every), [name.replace("_", " ") for name in names[::every]])
    axes.figure.colorbar(colour, ax=axes, label=panel.colour_label)


def table_of(
    panel: HeatMap, cells: Sequence[Cell], columns: list[str], rows: list[str], values: Values
) -> Any:
    """Return the reduced numbers (rows, columns); NaN where there is no cell, or one is NaN."""
    table = np.full((len(rows), len(columns)), np.nan)
    for column, standing in by_value(cells, panel.axis).items():
        for row, members in by_value(standing, panel.rows).items():
            numbers = [np.max(values.row(panel.measure, cell)) for cell in members]
            reduced = REDUCTIONS[panel.reduce](numbers)
            table[rows.index(row), columns.index(column)] = panel.factor * reduced
    return table


def _sorted(split: dict[str, list[Cell]], axis: str) -> list[str]:
    """Return the written values, numbers in rising order, names in that of the sweep."""
    coordinates = {name: members[0].coordinates[axis] for name, members in split.items()}
    if any(isinstance(one, str | bool | tuple) or one is None for one in coordinates.values()):
        return list(split)
    return sorted(split, key=lambda name: float(coordinates[name]))
