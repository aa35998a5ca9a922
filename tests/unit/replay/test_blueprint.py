"""The layout of the viewer: everything in view, plots with margins, played slowly enough."""

from __future__ import annotations

import numpy as np
import pytest
import rerun.blueprint as rrb

from lavendersim.replay.blueprint import (
    MARGIN,
    SHOWN_SECONDS,
    contents_of,
    curves_view,
    laid_out,
)
from lavendersim.replay.layer import ALONE, Layer


def test_contacts_are_in_view_where_there_can_be_any() -> None:
    assert "/contacts/**" in contents_of(ALONE, True)
    assert contents_of(ALONE, False) == [
        "/bodies/**",
        "/connections/**",
        "/paths/**",
        "/grid/**",
        "/cell/**",
    ]
    assert contents_of(Layer("a"), False)[0] == "/a/bodies/**"


def ranges(
    values: list[float], seconds: float = 2.0, least: float = 0.0
) -> tuple[tuple[float, float], list[float]]:
    view = curves_view("/plot", "depth [mm]", np.array(values), seconds, least=least)
    axis = view.properties["ScalarAxis"].range.as_arrow_array().to_pylist()[0]
    shown = view.properties["TimeAxis"].view_range.as_arrow_array().to_pylist()[0]
    return tuple(axis), [shown[end]["value"] if isinstance(shown[end], dict) else shown[end] for end in ("start", "end")]  # noqa: E501  # fmt: skip


def test_no_curve_lies_on_the_frame() -> None:
    (low, high), _ = ranges([1.0, float("nan"), 3.0, float("inf")])
    assert (low, high) == pytest.approx((1.0 - 2.0 * MARGIN, 3.0 + 2.0 * MARGIN))
    assert ranges([5.0, 5.0])[0] == (4.0, 6.0)  # of a straight line a unit on both sides
    assert ranges([0.0, 1e-13], least=1e-6)[0] == pytest.approx((-1.0, 1.0))  # and of round-off
    low, high = ranges([])[0]
    assert low < 0.0 < 1.0 < high


@pytest.mark.parametrize(("seconds", "speed"), [(4.0, 0.5), (80.0, 1.0), (0.01, 0.05)])
def test_short_runs_are_slow_and_none_is_faster_than_life(seconds: float, speed: float) -> None:
    view = rrb.TimeSeriesView(origin="/plot")
    found = laid_out(view, seconds).time_panel
    assert found.playback_speed == pytest.approx(speed)
    assert min(max(seconds / SHOWN_SECONDS, 0.05), 1.0) == pytest.approx(speed)
    assert laid_out(view, seconds, 3.0).time_panel.playback_speed == 3.0
