"""Cost against contact count: medians where they were measured, and how they were."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import style

from lavendersim.figures.contact_cost import compose, draw_contact_cost
from lavendersim.figures.style import STYLE

FOUND = {
    "repeats": 9,
    "sweeps": 50,
    "environment": {"processor": "A processor"},
    "growth": [
        {"solver": "one_way", "contacts": 100, "samples": [3.0, 1.0, 2.0]},
        {"solver": "one_way", "contacts": 10, "samples": [5.0, 7.0, 6.0]},
        {"solver": "other", "contacts": 10, "samples": [9.0, 9.0, 9.0]},
    ],
}


def test_medians_are_drawn_by_rising_count_and_the_caption_says_how_they_were_taken() -> None:
    with style.context(STYLE, after_reset=True):
        figure = compose(FOUND)
    (axes,) = figure.axes
    one, other = (line.get_xydata() for line in axes.lines)
    np.testing.assert_array_equal(one, [[10.0, 6.0], [100.0, 2.0]])
    np.testing.assert_array_equal(other, [[10.0, 9.0]])
    (caption,) = (" ".join(text.get_text().split()) for text in figure.texts)
    for said in ("9 interleaved repeats of 50 sweeps", "A processor", "Compilation"):
        assert said in caption
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["one way", "other"]


def test_both_formats_are_written(tmp_path: Path) -> None:
    paths = draw_contact_cost(FOUND, tmp_path / "figures")
    assert [path.name for path in paths] == ["contact_cost.png", "contact_cost.svg"]
    assert all(path.stat().st_size > 1000 for path in paths)
