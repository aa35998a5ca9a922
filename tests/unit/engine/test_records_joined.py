"""Records have scalar fields at aligned places, each once, in the order of their groups."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine import records
from lavendersim.engine.records import dtype

GROUPS = {
    name: value
    for name, value in vars(records).items()
    if isinstance(value, list) and value and isinstance(value[0], tuple)
}


def test_groups_are_joined_in_order_and_a_name_is_taken_once() -> None:
    joined = dtype([("a", "f8"), ("b", "i8")], [("b", "i8"), ("c", "u8")], [("a", "f8")])
    assert joined.names == ("a", "b", "c")
    assert [joined[name].str[1:] for name in joined.names] == ["f8", "i8", "u8"]
    assert joined.isalignedstruct
    assert joined is dtype([("a", "f8"), ("b", "i8"), ("c", "u8")])  # made once


@pytest.mark.parametrize("name", GROUPS)
def test_fields_of_a_record_are_eight_bytes_and_named_once(name: str) -> None:
    fields = GROUPS[name]
    assert len({field for field, _ in fields}) == len(fields)
    assert {kind for _, kind in fields} <= {"f8", "i8", "u8"}
    assert dtype(fields).itemsize == 8 * len(fields)


def test_kinds_of_shapes_and_reasons_to_return_differ() -> None:
    shapes = [records.PLANE, records.SPHERE, records.BOX, records.CAPSULE, records.CYLINDER]
    assert sorted([*shapes, records.HULL, records.COMPOUND]) == list(range(7))
    returns = [records.RUNNING, records.ROWS_FULL, records.CONTACTS_FULL, records.PAIRS_FULL]
    assert len({*returns, records.WOKEN, records.DIVERGED}) == 6
    assert len({records.NOT_FINITE, records.TURNS_TOO_FAST, records.INACCURATE}) == 3


def test_lengths_that_touch_are_above_round_off_at_a_hundred_kilometres() -> None:
    assert np.spacing(1e5) < records.TOUCHING < 1e-6
    assert records.INSTANT < 1e-9
