"""What flies past a contact is not pushed: its row holds, with room for round-off and no more."""

from __future__ import annotations

import pytest

from lavendersim.engine.free_flight import LOOSE, target_of_flight

SPEEDS = [-1e3, -9.0, -1e-9, 0.0, 1e-9, 0.3, 1e3]


@pytest.mark.parametrize("v", SPEEDS)
def test_the_row_holds_without_a_push_by_less_than_anyone_sees(v: float) -> None:
    room = v + target_of_flight.py_func(v)  # v_n + target >= 0 is the row
    # Of the sum of two numbers of this size half a unit in the last place is left, twice.
    assert room == pytest.approx(LOOSE * (1.0 + abs(v)), abs=2.0**-52 * abs(v))
    assert 0.0 < room < 1e-8
