"""A panel of a cost table: whose settings are in it, and where those without an error stand."""

from __future__ import annotations

import math
from typing import Any

import pytest

from lavendersim.figures.cost_looks import PALE
from lavendersim.figures.cost_panels import BAND
from lavendersim.figures.work_precision import compose
from tests.made_costs import cost_table, row_data, spread


def points(axes: Any, marker: str) -> list[tuple[float, float]]:
    lines = [line for line in axes.lines if line.get_marker() == marker]
    return [(float(x), float(y)) for line in lines for x, y in line.get_xydata()]


def test_a_setting_stands_at_its_cost_and_error_and_one_that_failed_in_the_strip() -> None:
    """Whatever error it has: what fell over is no point to be read off the axis."""
    good = row_data(front=True, error=1e-3, ns_per_second=spread(4e6, 3e6, 5e6))
    none = row_data(sweeps=2, error=None, failed="diverged", ns_per_second=spread(1e6, 1e6, 1e6))
    wrong = none | {"sweeps": 3, "error": 1.0, "ns_per_second": spread(2e6, 2e6, 2e6)}
    panel = compose(cost_table(good, none, wrong)).axes[0]
    assert points(panel, "o") == [(4.0, 1e-3)]
    crossed = points(panel, "x")  # [ms]; in the middle of the strip
    assert [x for x, _ in crossed] == [1.0, 2.0]
    assert all(y == pytest.approx(0.5 * (BAND + 1.0)) for _, y in crossed)
    low, high = panel.get_ylim()
    assert math.log(1e-3 / low) / math.log(high / low) < BAND  # no other setting is in the strip
    assert "failed" in [text.get_text() for text in panel.texts]


def test_each_solver_has_a_panel_with_the_others_as_pale_dots() -> None:
    one = row_data(error=1e-3, ns_per_second=spread(4e6, 4e6, 4e6), front=True)
    other = row_data(solver="jacobi", error=1e-2, ns_per_second=spread(1e6, 1e6, 1e6), front=True)
    broken = other | {"failed": "diverged", "sweeps": 3, "front": False}
    first, second, _ = compose(cost_table(one, other, broken)).axes
    assert [axes.get_title(loc="left") for axes in (first, second)] == ["adaptive", "jacobi"]
    assert (points(first, "o"), points(first, ".")) == ([(4.0, 1e-3)], [(1.0, 1e-2)])
    assert (points(second, "o"), points(second, ".")) == ([(1.0, 1e-2)], [(4.0, 1e-3)])
    assert (len(points(first, "x")), len(points(second, "x"))) == (0, 1)
    dots = [line.get_color() for axes in (first, second) for line in axes.lines[:1]]
    assert dots == [PALE, PALE]
    assert first.get_ylim() == second.get_ylim()
    for axes in (first, second):  # the front of all solvers is in each
        stairs = [line for line in axes.lines if line.get_drawstyle() == "steps-post"]
        assert [list(line.get_xdata()) for line in stairs] == [[1.0, 4.0]]
