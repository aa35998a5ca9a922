"""The work-precision page: what its caption says, and where settings without an error stand."""

from __future__ import annotations

import math
from typing import Any

import pytest

from lavendersim.figures.work_precision import BAND, compose
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


def test_a_setting_stands_at_its_cost_and_error_and_one_that_failed_in_the_strip() -> None:
    """Whatever error it has: what fell over is no point to be read off the axis."""
    good = row_data(front=True, error=1e-3, ns_per_second=spread(4e6, 3e6, 5e6))
    none = row_data(sweeps=2, error=None, failed="diverged", ns_per_second=spread(1e6, 1e6, 1e6))
    wrong = none | {"sweeps": 3, "error": 1.0, "ns_per_second": spread(2e6, 2e6, 2e6)}
    work = compose(cost_table(good, none, wrong)).axes[0]
    marked = {tuple(line.get_xydata()[0]) for line in work.lines if line.get_marker() == "o"}
    assert marked == {(4.0, 1e-3)}
    # [ms]; one solver has one line, in the middle of the strip
    crossed = [tuple(line.get_xydata()[0]) for line in work.lines if line.get_marker() == "x"]
    assert [x for x, _ in crossed] == [1.0, 2.0]
    assert all(y == pytest.approx(0.5 * (BAND + 1.0)) for _, y in crossed)
    low, high = work.get_ylim()
    share = math.log(1e-3 / low) / math.log(high / low)
    assert share < BAND  # no other setting is in the strip


def test_slopes_are_named_in_the_legend_and_one_timestep_has_none() -> None:
    """On the panel their names lay on the curves."""
    coarse, fine = (row_data(timestep=h, ns_per_second=spread(1e6, 1e6, 1e6)) for h in STEPS)
    figure = compose(cost_table(coarse, fine))
    assert [len(axes.texts) for axes in figure.axes][1] == 0
    assert legend_of(figure)[-2:] == ["order 1", "order 2"]
    figure = compose(cost_table(coarse))
    assert len(figure.axes) == 2  # settings, legend
    assert "order 1" not in legend_of(figure)


def legend_of(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.axes[-1].get_legend().get_texts()]
