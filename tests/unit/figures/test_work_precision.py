"""The work-precision page: what its caption says, and that all of it can be read."""

from __future__ import annotations

from itertools import combinations
from typing import Any, get_args

from matplotlib import style
from matplotlib.text import Text

from lavendersim.cell.choices import Solver
from lavendersim.figures.style import STYLE
from lavendersim.figures.work_precision import compose
from tests.made_costs import cost_table, row_data, spread

STEPS = ("1/60", "1/240")
ANSWER = {"target": 0.01, "reached": True, "row": 0, "fragment": "numerics: default\n"}


def test_the_caption_says_machine_clock_repeats_and_spread() -> None:
    figure = compose(
        cost_table(
            row_data(role="specified", front=True),
            repeats=11,
            machine={"processor": "A processor of the year 2000"},
            targets=[ANSWER | {"sentence": "1 % costs 2 ms per simulated second"}],
        )
    )
    caption = " ".join(" ".join(text.get_text() for text in figure.texts).split())
    for part in (
        "A processor of the year 2000",
        "clock thread_time",
        "Medians of 11 interleaved repeats",
        "hold the median in 19 of 20 cases",
        "Neither compilation nor logging is in any time",
        "1 % costs 2 ms per simulated second",
    ):
        assert part in caption


def test_slopes_are_named_beside_the_panel_and_one_timestep_has_none() -> None:
    coarse, fine = (row_data(timestep=h, ns_per_second=spread(1e6, 1e6, 1e6)) for h in STEPS)
    figure = compose(cost_table(coarse, fine))
    assert {"order 1", "order 2", "adaptive"} == {text.get_text() for text in figure.axes[1].texts}
    assert "order 1" not in legend_of(figure)
    assert len(compose(cost_table(coarse)).axes) == 2  # settings, legend


def test_no_text_lies_upon_another() -> None:
    """Seven solvers that end at one error, an engine's page too: names, ticks, titles, targets."""
    solvers = get_args(Solver)
    many = [
        row_data(solver=solver, timestep=h, role=role, error=error, failed=failed)
        for solver in solvers
        for h in STEPS
        for role, error, failed in (("grid", 0.1, ""), ("specified", 1e-14, ""), ("grid", 9.0, "x"))
    ]
    targets = [ANSWER | {"target": target, "sentence": ""} for target in (1e-2, 1e-3)]
    engines = [row_data(engine=name, error=1e-9) for name in ("lavender", "mujoco", "bullet")]
    for table in (cost_table(*many, targets=targets), cost_table(*engines, targets=targets)):
        with style.context(STYLE, after_reset=True):
            figure = compose(table)
            figure.canvas.draw()
        boxes = [(text.get_text(), text.get_window_extent()) for text in texts_of(figure)]
        assert len(boxes) > 20
        for (one, box), (other, further) in combinations(boxes, 2):
            assert not box.overlaps(further), (one, other)
        for text, box in boxes:
            assert figure.bbox.x0 <= box.x0, text
            assert box.x1 <= figure.bbox.x1, text


def texts_of(figure: Any) -> list[Any]:
    """Every text that is drawn."""
    drawn = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text()]
    hidden = [
        label
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for tick in axis.get_major_ticks()
        for label in (tick.label1, tick.label2)
        if not axes.axison or not inside(axis, tick.get_loc())
    ]
    hidden += [
        text
        for axes in figure.axes
        if not axes.axison
        for text in (axes.xaxis.label, axes.yaxis.label, axes.title)
    ]
    return [text for text in drawn if text not in hidden]


def inside(axis: Any, place: float) -> bool:
    low, high = sorted(axis.get_view_interval())
    return bool(low <= place <= high)


def legend_of(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.axes[-1].get_legend().get_texts()]
