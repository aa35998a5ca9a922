"""Columns of the log: numbered once and for ever, those of a table in the order of the schema."""

from __future__ import annotations

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field

from lavendersim.trace.schema import (
    CONTACT_COLUMNS,
    EXTRA_FIELD_NUMBER,
    PLOTS,
    RESIDUAL_COLUMNS,
    STEP_COLUMNS,
    WORDS,
    columns_of,
)


def test_kinds_have_the_numbers_that_protobuf_gives_them() -> None:
    kinds = {"f8": Field.TYPE_DOUBLE, "i8": Field.TYPE_SFIXED64, "u8": Field.TYPE_FIXED64}
    assert kinds == WORDS


@pytest.mark.parametrize("columns", [STEP_COLUMNS, RESIDUAL_COLUMNS])
def test_names_and_numbers_are_each_once_and_mean_something(columns: tuple) -> None:
    assert len({one.name for one in columns}) == len(columns)
    assert len({one.number for one in columns}) == len(columns)
    assert all(0 < one.number < EXTRA_FIELD_NUMBER for one in columns)
    assert all(one.meaning and one.kind in WORDS for one in columns)


def test_what_is_drawn_is_a_column() -> None:
    assert set(PLOTS.values()) <= {one.name for one in STEP_COLUMNS}
    assert all(CONTACT_COLUMNS.values())


def test_columns_that_none_declares_come_behind_with_numbers_of_their_own() -> None:
    own = STEP_COLUMNS[1]
    table = np.dtype([("more", "f8"), (own.name, own.kind), ("most", "i8")])
    found = columns_of(table, STEP_COLUMNS)
    assert [one.name for one in found] == [own.name, "more", "most"]
    assert found[0] == own
    assert [one.number for one in found[1:]] == [EXTRA_FIELD_NUMBER + 1, EXTRA_FIELD_NUMBER + 2]


def test_a_column_of_less_than_eight_bytes_is_refused() -> None:
    with pytest.raises(TypeError, match="column 'small' is float32"):
        columns_of(np.dtype([("small", "f4")]), STEP_COLUMNS)
