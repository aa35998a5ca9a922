"""Tables of what effects cost, as `results.json` has them, with the numbers that a test says."""

from __future__ import annotations

from typing import Any

from lavendersim.measures.overhead_table import OverheadTable
from tests.made_costs import spread


def timed(effect: str, overhead: float, half: float = 0.25, **more: Any) -> dict[str, Any]:
    """Return a row that was timed: an overhead within +-`half` ns, on top of 150 ns."""
    return (
        gap(effect, "", required=False)
        | {"off": spread(150.0, 149.0, 151.0), "on": spread(150.0 + overhead, 149.0, 160.0)}
        | {"overhead": spread(overhead, overhead - half, overhead + half)}
        | {"within_noise": abs(overhead) <= half, "same_motion": True}
        | {"contacts_off": 0.0, "contacts_on": 0.0, "compile_s_off": 2.0, "compile_s_on": 3.0}
        | {"samples_off": [150.0], "samples_on": [150.0 + overhead]}
        | more
    )


def gap(effect: str, why_not: str, required: bool = True) -> dict[str, Any]:
    """Return a row without a timing."""
    row = {"effect": effect, "required": required, "reason": "", "unit": "body", "units": 1}
    return row | {"on_top_of": [], "why_not": why_not}


def table_data(*rows: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a table of some effects."""
    made = {"first_step": 0, "steps": 960, "repeats": 9, "clock": "fake", "bodies": 1}
    made |= {"processor": "A processor of the year 2000", "contacts_per_step": 24.0}
    return made | {"rows": list(rows)} | more


def overhead_table(*rows: dict[str, Any], **more: Any) -> OverheadTable:
    """Return the table that is read from this."""
    return OverheadTable.of(table_data(*rows, **more))
