"""Labels beside a panel stand apart, in their order, and as near to their lines as they can."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.optimize import minimize

from lavendersim.figures.labels_beside import LINE, LineEnd, apart, draw_labels_beside

GAP = 0.1


def test_labels_that_have_room_stay_where_their_lines_end() -> None:
    assert apart([0.9, 0.1, 0.4], GAP) == pytest.approx([0.9, 0.1, 0.4])


def test_labels_of_lines_that_end_together_are_a_gap_apart_around_them() -> None:
    assert apart([0.5, 0.5, 0.5], GAP) == pytest.approx([0.4, 0.5, 0.6])


def test_labels_stay_beside_the_axis() -> None:
    assert apart([0.0, 0.0], GAP) == pytest.approx([0.0, GAP])
    assert apart([1.0, 1.0], GAP) == pytest.approx([1.0 - GAP, 1.0])


def test_moves_are_the_least_squares_of_another_method() -> None:
    """SLSQP ends within its ftol of the least sum: 1e-12 of squares is 1e-6 of places."""
    sought = np.sort(np.random.default_rng(5).uniform(0.2, 0.8, 6))
    apart_by_gap = {"type": "ineq", "fun": lambda places: np.diff(places) - GAP}
    best = minimize(
        lambda places: ((places - sought) ** 2).sum(),
        0.1 + 0.15 * np.arange(6),
        constraints=[apart_by_gap],
        options={"ftol": 1e-13, "maxiter": 500},
    )
    assert best.success
    assert apart(list(sought), GAP) == pytest.approx(list(best.x), abs=1e-5)


def test_a_label_stands_at_its_leaders_end_and_the_leader_begins_at_its_line() -> None:
    axes = Figure().subplots()
    axes.set_yscale("log")
    axes.set_ylim(1e-4, 1.0)
    ends = [LineEnd("one", 1e-2, {"color": "red"}), LineEnd("two", 1e-2, {"color": "blue"})]
    draw_labels_beside(axes, ends, 10.0 * LINE)
    assert [text.get_text() for text in axes.texts] == ["one", "two"]
    for text, line, place in zip(axes.texts, axes.lines, (0.45, 0.55), strict=True):
        assert list(line.get_ydata()) == pytest.approx([0.5, place])
        assert text.get_position()[1] == pytest.approx(place)
