"""Panels of one page: those of the same many series share a legend beneath them."""

from __future__ import annotations

from swept_pages import LABELS, cell, page


def test_panels_of_the_same_many_series_share_a_legend_beneath_them() -> None:
    cells = [
        cell({"solver": f"way_{k}", "mass": mass}, 0.1 * mass) for k in range(5) for mass in (1, 2)
    ]
    panel = LABELS | {
        "kind": "measure_against_axis",
        "measure": "impulse",
        "axis": "mass",
        "series": "solver",
        "series_label": "{}",
    }
    many = page(panel, cells, panel)
    assert [axes.get_legend() for axes in many.axes] == [None, None]
    (legend,) = many.legends
    assert [text.get_text() for text in legend.get_texts()] == [f"way {k}" for k in range(5)]
    few = page(panel, cells[:4], panel)
    assert not few.legends
    assert all(axes.get_legend() for axes in few.axes)
