"""The work-precision page: what its caption says, and where settings without an error stand."""

from __future__ import annotations

from lavendersim.figures.work_precision import BAND, compose
from tests.made_costs import cost_table, row_data, spread

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


def test_a_setting_stands_at_its_cost_and_error_and_one_without_error_in_the_band() -> None:
    good = row_data(front=True, error=1e-3, ns_per_second=spread(4e6, 3e6, 5e6))
    failed = row_data(sweeps=2, error=None, failed="diverged", ns_per_second=spread(1e6, 1e6, 1e6))
    work = compose(cost_table(good, failed)).axes[0]
    marked = {tuple(line.get_xydata()[0]) for line in work.lines if line.get_marker() == "o"}
    # [ms]; the band begins at BAND of the axis and ends with it
    assert marked == {(4.0, 1e-3), (1.0, 0.5 * (BAND + 1.0))}
    (crossed,) = (line for line in work.lines if line.get_marker() == "x")
    assert crossed.get_xdata()[0] == 1.0
