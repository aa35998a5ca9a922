"""The table of what accuracy costs: written, read again, and refused where it is damaged."""

from __future__ import annotations

import json
from typing import Any

import pytest

from lavendersim.measures.cost_table import CostTable
from tests.made_costs import cost_table, row_data, table_data


def test_a_table_is_written_as_it_was_read() -> None:
    data = table_data(row_data(accuracy=1e-3), **{"from": 0.25, "overrides": ["set duration=1"]})
    table = CostTable.of(data)
    assert table.begin == 0.25
    written = json.loads(json.dumps(table.as_data()))
    assert CostTable.of(written) == table
    own = {"front": False, "engine": "lavender", "settings": {}, "least_error": None}
    own |= {"contacts": None, "iterations": None}
    added = {"rows": [row_data(accuracy=1e-3, **own)]}
    added |= {"interrupted": "", "quick": False, "refused": {}, "sentences": [], "efforts": {}}
    assert written == data | added
    assert list(written["rows"][0])[:5] == ["role", "preset", "timestep", "solver", "sweeps"]


def test_a_table_of_before_says_neither_accuracies_nor_overrides() -> None:
    table = cost_table(row_data())
    assert table.overrides == []
    assert not table.rows[0].is_controlled


@pytest.mark.parametrize("change", [{"error": "none"}, {"ns_per_second": 2.0}, {"timestep": None}])
def test_a_row_with_another_kind_of_value_is_refused(change: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(change))):
        cost_table(row_data(**change))


@pytest.mark.parametrize("key", ["rows", "error", "machine", "from"])
def test_a_table_that_lacks_a_key_is_refused(key: str) -> None:
    data = table_data(row_data())
    del data[key]
    with pytest.raises(ValueError, match="begin" if key == "from" else key):
        CostTable.of(data)


@pytest.mark.parametrize(
    "change", [{"error": None}, {"ns_per_second": None}, {"failed": "not met"}]
)
def test_what_failed_has_no_error_or_was_not_timed_is_no_answer(change: dict[str, Any]) -> None:
    assert cost_table(row_data()).rows[0].is_answer
    assert not cost_table(row_data(**change)).rows[0].is_answer
