"""Which settings a curve of the work-precision page joins."""

from __future__ import annotations

from lavendersim.figures.cost_looks import curves_of
from tests.made_costs import cost_table, row_data


def test_curves_join_what_differs_in_the_knob_of_which_there_are_most() -> None:
    rows = [
        row_data(timestep=step, sweeps=sweeps) for step in ("1/60", "1/120") for sweeps in (8, 2, 4)
    ]
    curves = list(curves_of(cost_table(*rows).rows))
    assert [[one.sweeps for one in curve] for curve in curves] == [[2, 4, 8], [2, 4, 8]]
    assert [{one.timestep for one in curve} for curve in curves] == [{"1/60"}, {"1/120"}]


def test_accuracies_that_were_asked_for_are_a_curve_of_their_own() -> None:
    rows = [row_data(), row_data(accuracy=1e-3), row_data(accuracy=1e-4), row_data(role="chapter")]
    curves = list(curves_of(cost_table(*rows).rows))
    assert [[one.accuracy for one in curve] for curve in curves] == [[None], [1e-3, 1e-4]]
