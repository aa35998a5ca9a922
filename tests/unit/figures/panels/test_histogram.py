"""A histogram: each value in one bin, all series over the same bins, what has no place counted."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from lavendersim.figures.panels.histogram import draw_panel, edges_of
from lavendersim.figures.specs.histogram import Histogram

LABELS = {
    "kind": "histogram",
    "measure": "height",
    "x_label": "height [m]",
    "y_label": "values [-]",
}
VALUES = np.random.default_rng(7).normal(3.0, 0.5, 400)


def panel(**given: Any) -> Histogram:
    return Histogram.model_validate(LABELS | given)


def drawn(spec: Histogram, *series: list[float]) -> list[Any]:
    """Return the outlines of the bars, one a series: each value a cell of its own."""
    cells = [
        SimpleNamespace(coordinates={"e": index}, value=value)
        for index, values in enumerate(series)
        for value in values
    ]
    values = SimpleNamespace(row=lambda measure, cell: np.atleast_1d(np.array(cell.value, float)))
    axes = Figure().subplots()
    draw_panel(axes, spec, cells, values, None)
    return list(axes.patches)


@pytest.mark.parametrize("bins", [None, 1, 7])
def test_every_value_is_in_one_bin(bins: int | None) -> None:
    (bars,) = drawn(panel(bins=bins), list(VALUES))
    counts, edges, _ = bars.get_data()
    # a bin has its lower edge, the last one its upper edge, too
    below = [np.count_nonzero(edge > VALUES) for edge in edges[:-1]] + [len(VALUES)]
    assert counts.tolist() == np.diff(below).tolist()
    assert counts.sum() == 400
    assert len(counts) == (bins or 20)  # the root of 400
    np.testing.assert_allclose(
        np.diff(edges), (VALUES.max() - VALUES.min()) / len(counts), rtol=1e-12
    )


def test_series_have_the_same_bins_and_their_shares_add_up_to_one() -> None:
    one, other = drawn(panel(series="e", count="share", factor=1000), [1.0, 2.0, 3.0, 4.0], [2.5])
    np.testing.assert_array_equal(one.get_data()[1], other.get_data()[1])
    assert one.get_data()[1][[0, -1]].tolist() == [1000.0, 4000.0]
    assert one.get_data()[0].sum() == other.get_data()[0].sum() == 1.0
    assert one.get_linestyle() != other.get_linestyle()
    assert [bars.get_label() for bars in (one, other)] == ["e = 0", "e = 1"]


def test_what_has_no_place_is_counted_in_the_legend() -> None:
    (bars,) = drawn(panel(x_limits=(0.0, 3.0)), [1.0, 2.0, float("nan"), float("inf"), 4.0])
    assert bars.get_label() == "(3 of 5 without a place)"
    assert bars.get_data()[0].sum() == 2
    (bars,) = drawn(panel(x_scale="log"), [-1.0, 0.0, 1.0, 10.0])
    assert bars.get_label() == "(2 of 4 without a place)"


def test_bins_of_a_logarithmic_axis_have_equal_ratios() -> None:
    edges = edges_of(panel(x_scale="log", bins=4), np.array([1.0, 10000.0]))
    np.testing.assert_allclose(edges, [1.0, 10.0, 100.0, 1000.0, 10000.0], rtol=1e-14)


@pytest.mark.parametrize("scale", ["linear", "log"])
@pytest.mark.parametrize("value", [2.0, 1e-9, 3e8])
def test_equal_values_lie_in_the_middle(scale: str, value: float) -> None:
    """To round-off: values that differ by it have no width of their own."""
    alike = np.array([value, value * (1 + 2e-16)])
    edges = edges_of(panel(bins=3, x_scale=scale), alike)
    assert edges[1] < value < edges[2]


def test_without_a_value_there_are_empty_bars() -> None:
    (bars,) = drawn(panel(), [float("nan")])
    assert not bars.get_data()[0].any()
