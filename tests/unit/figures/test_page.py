"""The composer: whatever surrounds the panels of a page, they keep the size that they are given."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath

from lavendersim.figures import page as composer
from lavendersim.figures.page import MARGIN, Page, blank, legend_above, legend_below, wrapped, write
from lavendersim.figures.style import DPI, LINE_HEIGHT, STYLE

PLAIN = Page("What to see.", 8.0, 3.0)


def space_of_panels(figure: Figure) -> tuple[float, float, float]:
    """Return how much stands below, in and above the place of the panels [inch]."""
    _, bottom, width, height = figure.get_layout_engine().get()["rect"]
    assert width == 1.0
    whole = figure.get_figheight()
    return bottom * whole, height * whole, (1.0 - bottom - height) * whole


@pytest.mark.parametrize(
    ("page", "below", "above"),
    [
        (PLAIN, LINE_HEIGHT + 2 * MARGIN, MARGIN),
        (PLAIN._replace(question="Why?"), LINE_HEIGHT + 2 * MARGIN, LINE_HEIGHT + 2 * MARGIN),
        # eight inches hold two entries of a legend: five entries are three lines
        (PLAIN._replace(legend_above=5), LINE_HEIGHT + 2 * MARGIN, 3 * LINE_HEIGHT + 2 * MARGIN),
        (PLAIN._replace(legend_below=5), 4 * LINE_HEIGHT + 3 * MARGIN, MARGIN),
    ],
    ids=["caption", "question", "legend above", "legend below"],
)
def test_panels_keep_their_height(page: Page, below: float, above: float) -> None:
    assert space_of_panels(blank(page)) == pytest.approx((below, 3.0, above))


def test_a_long_caption_makes_the_page_higher_and_stays_inside_it() -> None:
    page = PLAIN._replace(caption="many words " * 40)
    figure = blank(page)
    assert figure.get_figheight() > blank(PLAIN).get_figheight()
    figure.canvas.draw()
    for text in figure.texts:
        box = text.get_window_extent()
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1


def test_no_word_is_lost_where_lines_break() -> None:
    text = " ".join(f"word{k}" for k in range(60))
    lines = wrapped(text, 4.0).split("\n")
    assert len(lines) > 1
    assert " ".join(lines) == text


def test_a_legend_below_names_every_label_once() -> None:
    page = PLAIN._replace(legend_below=2)
    figure = blank(page)
    for axes in figure.subplots(1, 2):
        axes.plot([0.0, 1.0], label="one")
        axes.plot([1.0, 0.0], label="other")
    legend_below(figure, page)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["one", "other"]


def test_a_page_is_written_as_png_and_svg_of_equal_bytes(tmp_path: Path) -> None:
    def compose(label: str) -> Figure:
        page = PLAIN._replace(legend_above=1)
        figure = blank(page)
        legend_above(figure, page, [Line2D([], [], label=label)])
        return figure

    first, second = (write(tmp_path / folder / "page", compose, "one") for folder in "ab")
    assert [path.name for path in first] == ["page.png", "page.svg"]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]


def frames(svg: str) -> np.ndarray:
    """Return x, y, width and height of the panels [points], (panels, 4)."""
    found = re.findall(r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"/>', svg)
    return np.array(found, dtype=float)


def test_files_are_those_that_matplotlib_saves(tmp_path: Path) -> None:
    """`savefig` draws a page once for its layout and once more, and lays each file out anew.

    Ours are laid out once, with the widths of hinted letters: by outlines, as in the SVG, a label
    is up to a point narrower.
    """

    def compose(label: str) -> Figure:
        figure = blank(PLAIN)
        for axes in figure.subplots(1, 2):
            axes.semilogy([1e-9, 1e-3, 1.0], label=label)
            axes.set_title(label)
            axes.legend(loc="best")
        return figure

    png, svg = write(tmp_path / "page", compose, "one")
    with style.context(STYLE, after_reset=True):
        figure = compose("one")
        figure.savefig(tmp_path / "saved.png", dpi=DPI, metadata={"Software": None})
        figure.savefig(tmp_path / "saved.svg", metadata={"Date": None, "Creator": "lavender"})
        figure = compose("one")
        figure.savefig(tmp_path / "first.png", dpi=DPI)
        figure.set_layout_engine("none")  # stays as it was laid out for the PNG
        figure.savefig(tmp_path / "laid.svg", metadata={"Date": None, "Creator": "lavender"})
    assert png.read_bytes() == (tmp_path / "saved.png").read_bytes()
    assert svg.read_bytes() == (tmp_path / "laid.svg").read_bytes()
    ours, theirs = (frames(path.read_text()) for path in (svg, tmp_path / "saved.svg"))
    assert len(ours) == 2
    assert ours == pytest.approx(theirs, abs=1.0)  # points


def test_a_page_is_drawn_once_for_each_of_its_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda self, to: (drawn.append(self), draw(self, to))[1])
    write(tmp_path / "page", blank, PLAIN)
    assert len(drawn) == 2


@pytest.mark.parametrize("weight", [400, 700], ids=["caption", "question"])
def test_the_width_of_a_word_is_that_of_its_curves(weight: int) -> None:
    font = FontProperties(weight=weight, size=STYLE["font.size"], family=STYLE["font.family"])
    for word in ("Signorini", "(gjqy)", "8.5e-9", "\u0394t\u00b2", "W@&%S"):
        width = TextPath((0, 0), word, prop=font).get_extents().width
        assert composer._text_width(word, font) == pytest.approx(width, rel=1e-12)
