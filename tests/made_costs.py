"""Tables of what accuracy costs, as `cost.json` has them, with the numbers that a test says."""

from __future__ import annotations

from typing import Any

from lavendersim.measures.cost_table import CostTable


def row_data(**more: Any) -> dict[str, Any]:
    """Return a setting that was timed: 2 ms per simulated second."""
    made = {"role": "grid", "preset": "default", "timestep": "1/240", "solver": "adaptive"}
    made |= {"sweeps": 8, "tolerance": None, "warm_start": True, "fragment": "numerics: default\n"}
    made |= {"error": 0.1, "worst_at": "", "order": None, "law": "rigid contacts", "failed": ""}
    made |= {"worst_residual": 1e-10, "not_converged_steps": 0, "steps": 240}
    made |= {"samples": [2e6], "timed_seconds": 1.0, "compile_s": 0.5}
    made |= {"ns_per_second": spread(2e6, 1.9e6, 2.2e6)}
    return made | more


def spread(median: float, low: float, high: float) -> dict[str, float]:
    """Return a spread as it is written, with its quartiles at the median."""
    quartiles = {"lower_quartile": median, "upper_quartile": median}
    return {"median": median, **quartiles, "low": low, "high": high}


def table_data(*rows: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a table of some settings."""
    made = {"experiment": "ball", "config": "ball.yaml", "question": "", "axes": []}
    made |= {"error": {"measure": "apex", "truth": 1.0, "scale": None}, "clock": "thread_time"}
    made |= {"cells_per_setting": 1, "machine": {"processor": "one"}, "repeats": 7, "from": 0.0}
    made |= {"duration": 1.0, "truth": None, "targets": [], "rows": list(rows)}
    return made | more


def cost_table(*rows: dict[str, Any], **more: Any) -> CostTable:
    """Return the table that is read from this."""
    return CostTable.of(table_data(*rows, **more))
