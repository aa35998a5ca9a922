"""Panels of whole sweeps: limits of an axis over two others, a measure by name, shared legends."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib import style
from pydantic import ValidationError
from synthetic import SyntheticCell, ball_and_floor, trace_of

from lavendersim.figures.config_figure import compose
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.figures.style import STYLE
from lavendersim.measures.specs.impact import ImpactImpulse

BOUND = 1.0
STEPS = (Fraction(1, 60), Fraction(1, 120), Fraction(1, 240))
LABELS = {"title": "one idea", "x_label": "ratio [-]", "y_label": "solver"}
MAP = LABELS | {
    "kind": "stability_map",
    "axis": "mass",
    "rows": "solver",
    "find": "largest",
    "of": "timestep",
    "measure": "impulse",
    "at_most": BOUND,
}
NAMES = LABELS | {"kind": "measure_by_name", "measure": "impulse", "axis": "solver"}


def cell(coordinates: dict[str, Any], impulse: float, status: str = "complete") -> SyntheticCell:
    """A cell whose measure is a given impulse."""
    log = trace_of([0.0] * 4, [(2, impulse, 1e-4)], resolved=ball_and_floor(position=[0, 0, 0.1]))
    log.status = status
    return SyntheticCell(coordinates, log)


def column(mass: int, *outcomes: tuple[float, str]) -> list[SyntheticCell]:
    """Cells of one mass at falling timesteps."""
    return [
        cell({"mass": mass, "solver": "one_way", "timestep": step}, *outcome)
        for step, outcome in zip(STEPS, outcomes, strict=True)
    ]


def page(panel: dict[str, Any], cells: list[SyntheticCell], *more: dict[str, Any]) -> Any:
    experiment = SimpleNamespace(
        name="some_experiment",
        measures={"impulse": ImpactImpulse(kind="impact_impulse", body="ball")},
        config=SimpleNamespace(
            question="What is asked?",
            figure=FigureSpec.model_validate({"caption": "See.", "panels": (panel, *more)}),
            overhead=None,
            sweep={},
        ),
    )
    with style.context(STYLE, after_reset=True):
        return compose(experiment, cells)


GOOD, BAD = (0.5, "complete"), (2.0, "complete")
FLOWN, UNKNOWN = (0.5, "diverged: body ball"), (float("nan"), "complete")


@pytest.mark.parametrize(
    ("outcomes", "limit"),
    [
        ((GOOD, GOOD, GOOD), "1/60"),
        ((BAD, GOOD, GOOD), "1/120"),
        # What holds beyond a failure holds by luck.
        ((GOOD, BAD, GOOD), "1/240"),
        ((GOOD, GOOD, BAD), "none"),
        ((FLOWN, GOOD, GOOD), "1/120"),
        ((UNKNOWN, GOOD, GOOD), "1/120"),
    ],
)
def test_the_largest_stable_value_is_reached_from_the_smallest(
    outcomes: tuple[tuple[float, str], ...], limit: str
) -> None:
    axes = page(MAP, column(1, *outcomes)).axes[0]
    assert [text.get_text() for text in axes.texts] == [limit]


def test_the_least_value_is_reached_from_the_largest() -> None:
    axes = page(MAP | {"find": "least"}, column(1, GOOD, GOOD, BAD)).axes[0]
    assert [text.get_text() for text in axes.texts] == ["1/120"]


def test_every_cell_of_a_place_must_hold() -> None:
    phases = [
        cell({"mass": 1, "solver": "one_way", "timestep": STEPS[0], "phase": phase}, impulse)
        for phase, impulse in enumerate((0.5, 2.0))
    ]
    assert [text.get_text() for text in page(MAP, phases).axes[0].texts] == ["none"]


def test_a_map_names_its_places_and_frames_the_default() -> None:
    cells = [*column(1, GOOD, GOOD, GOOD), *column(10, BAD, BAD, GOOD)]
    axes = page(MAP | {"default": {"mass": 10}}, cells).axes[0]
    assert [label.get_text() for label in axes.get_xticklabels()] == ["1", "10"]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["one way"]
    assert [text.get_text() for text in axes.texts] == ["1/60", "1/240"]
    frames = [patch for patch in axes.patches if not patch.get_fill()]
    assert [(frame.get_x(), frame.get_width()) for frame in frames] == [(0.5, 1)]


def test_a_measure_by_name_shows_the_largest_of_each_name() -> None:
    cells = [
        cell({"solver": name, "phase": phase}, impulse)
        for name, impulses in (("one_way", (0.1, 0.3)), ("other", (0.2, 0.05)))
        for phase, impulse in enumerate(impulses)
    ]
    axes = page(NAMES | {"x_scale": "log"}, cells).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["one way", "other"]
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), [0.3, 0.2])


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


def test_slopes_for_comparison_go_through_the_last_point() -> None:
    cells = [cell({"step": step}, impulse) for step, impulse in ((1.0, 0.5), (2.0, 0.8))]
    panel = LABELS | {
        "kind": "measure_against_axis",
        "measure": "impulse",
        "axis": "step",
        "orders": (2,),
    }
    lines = {line.get_label(): line for line in page(panel, cells).axes[0].lines}
    np.testing.assert_allclose(lines["order 2"].get_ydata(), [0.2, 0.8], rtol=1e-15)


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


def luminance(colour: str) -> float:
    red, green, blue = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_more_than_five_series_of_numbers_are_lines_from_dark_to_light() -> None:
    values = [4, 1, 6, 2, 5, 3, 7]  # in the order of the sweep, which is no rising one
    cells = [cell({"mass": mass, "v": v}, 0.1 * mass * v) for v in values for mass in (1, 2)]
    panel = LABELS | {
        "kind": "measure_against_axis",
        "measure": "impulse",
        "axis": "mass",
        "series": "v",
        "series_label": "{} m/s",
    }
    axes = page(panel, cells).axes[0]
    assert {line.get_marker() for line in axes.lines} == {""}
    assert {line.get_linestyle() for line in axes.lines} == {"-"}
    by_value = sorted(zip(values, axes.lines, strict=True), key=lambda pair: pair[0])
    shades = [luminance(line.get_color()) for _, line in by_value]
    assert shades == sorted(shades)
    assert len(set(shades)) == len(values)
    assert shades[-1] < 0.75  # still seen on white
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert sorted(legend) == ["1 m/s", "4 m/s", "7 m/s"]  # lowest, middle, highest
    few = page(panel, cells[:10]).axes[0]
    assert "" not in {line.get_marker() for line in few.lines}


def test_a_trajectory_is_a_line_of_two_coordinates_from_a_dot() -> None:
    one = SyntheticCell({"v": 1}, trace_of([0.0, 0.1, 0.3, 0.6], resolved=ball_and_floor()))
    panel = LABELS | {"kind": "trajectory", "bodies": ("ball",), "window": (0.005, 0.03)}
    axes = page(panel, [one]).axes[0]
    way, start = axes.lines
    column = list(one.trace().bodies).index("ball")
    np.testing.assert_array_equal(way.get_xydata(), one.trace().pose[1:, column][:, [0, 2]])
    np.testing.assert_array_equal(start.get_xydata(), way.get_xydata()[:1])


def test_a_coordinate_over_time_is_that_of_its_body() -> None:
    one = SyntheticCell({"v": 1}, trace_of([0.0, 0.1, 0.3, 0.6], resolved=ball_and_floor()))
    panel = LABELS | {"kind": "time_series", "column": "position_z", "body": "ball"}
    (line,) = page(panel, [one]).axes[0].lines
    column = list(one.trace().bodies).index("ball")
    np.testing.assert_array_equal(line.get_ydata(), one.trace().pose[:, column, 2])
    assert len(set(line.get_ydata())) == 4


def test_a_coordinate_of_no_body_is_refused() -> None:
    panel = LABELS | {"kind": "time_series", "column": "position_z"}
    with pytest.raises(ValidationError, match="expected key `body`"):
        FigureSpec.model_validate({"caption": "See.", "panels": (panel,)})
