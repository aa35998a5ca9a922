"""A table of overheads comes back as it was written, with and without a timing."""

from __future__ import annotations

import json

import pytest

from lavendersim.measures.overhead_table import OverheadRow, OverheadTable, OverheadTiming
from lavendersim.measures.spread import Spread

NUMBERS = len(Spread.__annotations__)
SPREADS = [Spread(*(float(k) for k in range(first, first + NUMBERS))) for first in (1, 2, 3)]
TIMING = OverheadTiming(True, 4.0, 4.5, 12.0, 12.5, *SPREADS, False, [1.0, 2.0], [3.0, 4.0])
ROWS = [
    OverheadRow("drag", True, "the ball has it", "body", 3.0, [], "", TIMING),
    OverheadRow("midpoint", False, "no gravity", "body", 3.0, ["gravity"], "another law", None),
]
TABLE = OverheadTable(10, 100, 5, "thread", "made", 3, 4.0, ROWS)


def test_there_and_back() -> None:
    data = json.loads(json.dumps(TABLE.as_data()))
    assert OverheadTable.of(data) == TABLE


def test_numbers_of_a_timing_stand_beside_those_of_their_row() -> None:
    one, other = TABLE.as_data()["rows"]
    assert one["contacts_on"] == 4.5
    assert "contacts_on" not in other


def test_what_is_missing_is_refused() -> None:
    data = TABLE.as_data()
    del data["rows"][0]["contacts_on"]
    with pytest.raises(ValueError, match="contacts_on"):
        OverheadTable.of(data)
