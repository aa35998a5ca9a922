"""How solvers look on a page that compares them: colour, marker and line, and the legend above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lavendersim.figures.page import Page, blank, legend_above
from lavendersim.figures.style import LOOKS, look


def page_of_solvers(solvers: Sequence[str], width: float, height: float, caption: str) -> Figure:
    """Return a figure with the legend of the solvers above its panels of `height` [inch]."""
    page = Page(caption, width, height, legend_above=len(solvers), gaps=(0.08, 0.08))
    figure = blank(page)
    handles = [Line2D([], [], label=plain(name), **marks(solvers, name)) for name in solvers]
    legend_above(figure, page, handles)
    return figure


def plain(name: str) -> str:
    """Return a solver's name in words."""
    return name.replace("_", " ")


def marks(solvers: Sequence[str], name: str) -> dict[str, Any]:
    """Return how a solver is drawn on every page; dashed once colours and markers are used up."""
    index = list(solvers).index(name)
    shown = look(index)
    return {
        "color": shown.colour,
        "marker": shown.marker,
        "linestyle": "-" if index < len(LOOKS) else (0, (4, 2)),
        "linewidth": 1.3,
        "markersize": 5.0,
        "markeredgecolor": shown.colour,
    }


def span(values: Sequence[int]) -> str:
    """Return how many repeats there were, or from how many to how many."""
    low, high = min(values, default=1), max(values, default=1)
    return f"{low} repeat{'' if low == 1 else 's'}" if low == high else f"{low} to {high} repeats"
