"""Which setting stands for a timestep where only the timestep is meant to make an error."""

from __future__ import annotations

from lavendersim.figures.timestep_errors import best_solved
from tests.made_costs import cost_table, row_data


def test_a_tolerance_outbids_any_number_of_sweeps_and_warm_starts_cold() -> None:
    rows = [
        row_data(timestep="1/60", sweeps=1000),
        row_data(timestep="1/60", sweeps=50, tolerance=1e-6),
        row_data(timestep="1/60", sweeps=50, tolerance=1e-9),
        row_data(timestep="1/120", sweeps=8, warm_start=False),
        row_data(timestep="1/120", sweeps=8),
        row_data(timestep="1/120", sweeps=4),
    ]
    (curve,) = best_solved(cost_table(*rows).rows)
    assert [(one.timestep, one.tolerance) for one in curve] == [("1/120", None), ("1/60", 1e-9)]
    assert (curve[0].sweeps, curve[0].warm_start) == (8, True)
