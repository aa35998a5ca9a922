"""The figure of overheads: every effect has a place, every number a mark, every gap a reason."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from matplotlib import style
from matplotlib.figure import Figure

from lavendersim.figures import draw, draw_overheads
from lavendersim.figures.overheads import IDLE, LOWEST, MOVES, REQUIRED, STRIP, compose
from lavendersim.figures.style import STYLE
from lavendersim.measures.overhead_table import OverheadTable
from tests.made_overheads import gap, overhead_table, timed

IN_STRIP = LOWEST / STRIP**0.8  # where the marker of what is less than the axis has stands
ROWS = (
    timed("drag", 2.5),
    timed("gravity", 400.0, required=True, same_motion=False),
    timed("step_log", 70.0, required=True),
    timed("friction", -0.1, unit="contact"),
    gap("rotation", "friction needs it"),
)


def table(*rows: dict[str, Any]) -> OverheadTable:
    return overhead_table(*(rows or ROWS))


def run_of(name: str, overheads: OverheadTable | None) -> Any:
    return SimpleNamespace(
        name=name,
        overheads=lambda: overheads,
        cells=(),
        experiment=SimpleNamespace(
            name=name, config=SimpleNamespace(figure=None, overhead=object())
        ),
    )


def page(*tables: tuple[str, OverheadTable]) -> Figure:
    with style.context(STYLE, after_reset=True):
        figure = compose(tables)
        figure.canvas.draw()
    return figure


def marks(axes: Any) -> dict[float, Any]:
    """Markers by their place along the axis of overheads."""
    lines = [line for line in axes.lines if line.get_marker() in ("o", "s")]
    return {float(line.get_xdata()[0]): line for line in lines}


def test_an_overhead_is_drawn_at_its_number_with_its_interval() -> None:
    axes = page(("sphere", table())).axes[0]
    found = marks(axes)
    assert set(found) == {2.5, 400.0, 70.0, IN_STRIP}
    bars = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) == 2]
    assert [2.25, 2.75] in [list(bar) for bar in bars]
    names = [text.get_text() for text in axes.get_yticklabels()]
    assert names == ["drag", "gravity", "step log", "friction", "rotation"]
    places = [found[overhead].get_ydata()[0] for overhead in (2.5, 400.0, 70.0, IN_STRIP)]
    assert places == [0, 1, 2, 3]


def test_colour_tells_who_calls_shape_the_unit_and_a_hollow_mark_noise() -> None:
    found = marks(page(("sphere", table())).axes[0])
    colours = [found[overhead].get_color() for overhead in (2.5, 400.0, 70.0, IN_STRIP)]
    assert colours == [IDLE, MOVES, REQUIRED, IDLE]
    assert [found[overhead].get_marker() for overhead in (2.5, 400.0, IN_STRIP)] == ["o", "o", "s"]
    assert [found[p].get_markerfacecolor() == "white" for p in (2.5, 400.0, IN_STRIP)] == [
        False,
        False,
        True,
    ]


def test_an_effect_without_an_overhead_says_why_in_its_row() -> None:
    texts = page(("sphere", table())).axes[0].texts
    assert ("friction needs it", 4) in [(text.get_text(), text.get_position()[1]) for text in texts]


def test_the_axis_carries_a_tenth_to_ten_thousand_and_less_stands_as_a_number_in_its_strip() -> (
    None
):
    axes = page(("sphere", table())).axes[0]
    assert axes.get_xscale() == "log"
    low, high = axes.get_xlim()
    assert high == 1e4
    shown = [text for text in axes.get_xticklabels() if low <= text.get_position()[0] <= high]
    assert [text.get_text() for text in shown] == ["less", "0.1", "1", "10", "100", "1k", "10k"]
    assert ("-0.1", 3) in [(text.get_text(), text.get_position()[1]) for text in axes.texts]
    assert low < IN_STRIP < LOWEST
    # of its interval, -0.35 to 0.15, the part that is on the axis
    bars = [list(line.get_xdata()) for line in axes.lines if len(line.get_xdata()) == 2]
    assert [LOWEST, pytest.approx(0.15)] in bars
    wide = page(("sphere", table(timed("drag", 12_345.0)))).axes[0]
    assert wide.get_xlim()[1] > 12_345.0


def test_several_scenes_share_the_names_of_effects() -> None:
    more = table(timed("drag", 1.0), timed("newton", 7.0))
    figure = page(("sphere", table()), ("pile", more))
    assert len(figure.axes) == 3  # a panel a scene, and compile times
    places = {overhead: line.get_ydata()[0] for overhead, line in marks(figure.axes[1]).items()}
    assert places == {1.0: 0, 7.0: 5}
    legend = figure.axes[2].get_legend()
    assert legend is not None
    assert {text.get_text() for text in legend.texts} == {"sphere", "pile"}


def test_compile_times_stand_beside_the_overheads() -> None:
    axes = page(("sphere", table(timed("drag", 1.0, compile_s_on=4.5)))).axes[1]
    lines = [(list(line.get_xdata()), list(line.get_ydata())) for line in axes.lines]
    assert ([4.5], [0]) in lines
    assert any(list(places) == [2.0, 2.0] for places, _ in lines)  # the plan's own


def test_the_caption_says_machine_repeats_and_spread() -> None:
    caption = " ".join(page(("sphere", table())).texts[0].get_text().split())
    for part in ("A processor of the year 2000", "9 interleaved repeats", "19 of 20"):
        assert part in caption


@pytest.mark.parametrize("overheads", [table(), None])
def test_a_run_without_a_figure_section_draws_its_overheads_if_it_has_any(
    overheads: dict[str, Any] | None, tmp_path: Path
) -> None:
    written = draw(run_of("sphere", overheads), tmp_path)
    names = [path.name for path in written]
    assert names == ([] if overheads is None else ["sphere_overheads.png", "sphere_overheads.svg"])
    assert all(path.stat().st_size > 1000 for path in written)


def test_equal_overheads_give_equal_files(tmp_path: Path) -> None:
    runs = [run_of("sphere", table()), run_of("stack", table()), run_of("pile", None)]
    first, second = (draw_overheads(runs, tmp_path / name) for name in ("a", "b"))
    assert [path.name for path in first] == ["overheads.png", "overheads.svg"]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
