"""A heat map: a tile with its number for each pair; hatched where there is none."""

from __future__ import annotations

from typing import Any

from swept_pages import LABELS, cell, page

HEAT = LABELS | {
    "kind": "heat_map",
    "measure": "impulse",
    "axis": "mass",
    "rows": "phase",
    "colour_label": "impulse [N s]",
}


def tiles(figure: Any) -> dict[tuple[float, float], Any]:
    """The tiles of a heat map by their centres."""
    patches = [patch for patch in figure.axes[0].patches if patch.get_width() == 1]
    return {(patch.get_x() + 0.5, patch.get_y() + 0.5): patch for patch in patches}


def test_a_heat_map_has_a_tile_with_its_number_for_each_pair_in_rising_order() -> None:
    numbers = {(10, 2): 4.0, (1, 2): 3.0, (10, 1): 2.0, (1, 1): 1.0}
    cells = [cell({"mass": mass, "phase": k}, one) for (mass, k), one in numbers.items()]
    figure = page(HEAT, cells)
    axes, bar = figure.axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["1", "10"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["1", "2"]
    found = {text.get_position(): text.get_text() for text in axes.texts}
    assert found == {(0, 0): "1", (1, 0): "2", (0, 1): "3", (1, 1): "4"}
    assert bar.get_ylabel() == "impulse [N s]"
    assert len({patch.get_facecolor() for patch in tiles(figure).values()}) == 4


def test_a_heat_map_reduces_other_axes_and_hatches_what_is_not_known() -> None:
    cells = [
        cell({"mass": 1, "phase": 1, "e": 0}, 1.0),
        cell({"mass": 1, "phase": 1, "e": 1}, 3.0),
        cell({"mass": 2, "phase": 1, "e": 0}, float("nan")),
    ]
    for reduce, shown in (("max", "3"), ("min", "1"), ("mean", "2")):
        figure = page(HEAT | {"reduce": reduce}, cells)
        assert [text.get_text() for text in figure.axes[0].texts] == [shown]
        assert [bool(tile.get_hatch()) for tile in tiles(figure).values()] == [False, True]
