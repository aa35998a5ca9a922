"""The composer: whatever surrounds the panels of a page, they keep the size that they are given."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lavendersim.figures.page import MARGIN, Page, blank, legend_above, legend_below, wrapped, write
from lavendersim.figures.style import LINE_HEIGHT

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
