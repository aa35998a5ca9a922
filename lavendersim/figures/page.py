"""The composer of every figure page: question above, panels, legend and caption; PNG and SVG.

    question                          all sizes are inches, and text is broken by the true
    legend above                      widths of its letters, so that panels keep their size
    [ panel ] [ panel ] [ panel ]     whatever surrounds them
    legend below
    caption
No pyplot: a page is a Figure with its own canvas, so drawing needs no display, keeps no global
state and starts faster. Equal numbers give equal bytes: no date, fixed ids, a font of our own.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from lavendersim.durable_files import path_name, write_together
from lavendersim.figures.style import DPI, LINE_HEIGHT, STYLE

POINTS_PER_INCH: Final = 72.0
HINTING: Final = 0.93  # letters placed on whole pixels run wider than their outlines
MARGIN: Final = 0.12  # [inch]
ENTRY_WIDTH: Final = 3.2  # [inch] of a legend's entry as long as the name of a solver
LINE_SPACING: Final = 1.25  # of a caption [-]


class Page(NamedTuple):
    """What a page is made of besides what its panels draw; sizes in inches."""

    caption: str
    width: float
    height: float  # of the panels alone
    question: str = ""
    legend_above: int = 0  # entries of a legend of all panels, at the top of a page
    legend_below: int = 0  # the same, between panels and caption
    gaps: tuple[float, float] = (0.12, 0.1)  # around a panel, sideways and upwards

    @property
    def columns(self) -> int:
        """How many entries of a legend stand side by side."""
        return max(1, int(self.width / ENTRY_WIDTH))

    def rows(self, entries: int) -> int:
        """Return how many lines a legend has."""
        return -(-entries // self.columns)


def write(stem: Path, compose: Callable[..., Figure], *values: Any) -> list[Path]:
    """Compose a page in the common style and write it as PNG and SVG; returns the files.

    The directory is made where it is missing. Where they cannot be written, on a full disk for
    example, earlier ones stay as they were.
    """
    paths = [stem.with_name(f"{path_name(stem.name)}.{suffix}") for suffix in ("png", "svg")]
    with style.context(STYLE, after_reset=True):
        figure = compose(*values)
        # `savefig` would draw a page twice for each file: once for its layout alone.
        usual = figure.dpi
        figure.dpi = DPI
        raster: Any = FigureCanvasAgg(figure)
        dots, text = io.BytesIO(), io.StringIO()
        raster.print_png(dots, metadata={"Software": None})
        figure.dpi = usual
        figure.set_layout_engine("none")  # panels stay where they are: that took a third of it
        vector: Any = FigureCanvasSVG(figure)
        vector.print_svg(text, metadata={"Date": None, "Creator": "lavender"})
    write_together({paths[0]: dots.getvalue(), paths[1]: text.getvalue()})
    return paths


def blank(page: Page) -> Figure:
    """Return a figure with question and caption, whose layout leaves their space to them."""
    caption = wrapped(page.caption, page.width)
    question = wrapped(page.question, page.width, weight="bold")
    above = _text_height(question) if question else MARGIN
    if page.legend_above:
        above = LINE_HEIGHT * page.rows(page.legend_above) + 2 * MARGIN
    below = _text_height(caption)
    if page.legend_below:
        below += LINE_HEIGHT * page.rows(page.legend_below) + MARGIN
    height = page.height + below + above
    figure = Figure(figsize=(page.width, height))
    FigureCanvasAgg(figure)
    figure.set_layout_engine(
        "constrained",
        rect=(0.0, below / height, 1.0, page.height / height),
        w_pad=page.gaps[0],
        h_pad=page.gaps[1],
    )
    left = MARGIN / page.width
    if question:
        figure.text(left, 1.0 - MARGIN / height, question, va="top", weight="bold")
    figure.text(left, MARGIN / height, caption, va="bottom", linespacing=LINE_SPACING)
    return figure


def legend_above(figure: Figure, page: Page, handles: Sequence[Any]) -> None:
    """Draw the legend of all panels at the top: many curves leave no corner of a panel free."""
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=page.columns,
        handlelength=2.4,
        borderaxespad=0.3,
    )


def legend_below(figure: Figure, page: Page) -> None:
    """Draw the legend of what panels have labelled between them and the caption, each once."""
    named: dict[str, Any] = {}
    for axes in figure.axes:
        handles, labels = axes.get_legend_handles_labels()
        for handle, label in zip(handles, labels, strict=True):
            named.setdefault(label, handle)
    bottom = _text_height(wrapped(page.caption, page.width)) / figure.get_figheight()
    legend = figure.legend(
        list(named.values()),
        list(named),
        loc="lower center",
        bbox_to_anchor=(0.5, bottom),
        ncols=page.columns,
        borderaxespad=0.0,
        borderpad=0.0,
    )
    legend.set_in_layout(False)  # its space is part of the page's height


def _text_height(text: str) -> float:
    return LINE_HEIGHT * (text.count("\n") + 1) + 2 * MARGIN


def wrapped(text: str, width: float, weight: str = "normal") -> str:
    """Break a text into lines that end inside the page, by the true widths of its letters."""
    font = FontProperties(weight=weight, size=STYLE["font.size"], family=STYLE["font.family"])
    left = most = HINTING * (width - 2 * MARGIN) * POINTS_PER_INCH
    space = _text_width("n n", font) - _text_width("nn", font)
    lines: list[list[str]] = [[]]
    for word in text.split():
        needed = _text_width(word, font) + space
        if lines[-1] and needed > left:
            lines.append([])
            left = most
        lines[-1].append(word)
        left -= needed
    return "\n".join(" ".join(line) for line in lines)


@cache
def _text_width(text: str, font: FontProperties) -> float:
    """Return the width of what is inked, which outlines of TrueType have points at the ends of."""
    outlines = TextPath((0, 0), text, prop=font)
    return float(np.ptp(outlines.vertices[outlines.codes != TextPath.CLOSEPOLY, 0]))
