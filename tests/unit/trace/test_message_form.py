"""Which slot of a message takes which number, and tables of records as words."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.trace.message_form import (
    NANOS,
    SECONDS,
    columns_of_words,
    heads_of,
    message_form,
    words_of,
)
from lavendersim.trace.wire import VARINT_WIDTH, Template

ROWS = np.array([(1, 2.5), (3, -4.0)], [("step", "i8"), ("speed", "f8")])


def test_rows_of_eight_bytes_are_words_as_they_stand() -> None:
    words = words_of(ROWS)
    assert words.shape == (2, 2)
    assert np.shares_memory(words, ROWS)
    assert words[:, 0].tolist() == [1, 3]
    assert words[:, 1].view(np.float64).tolist() == [2.5, -4.0]
    assert columns_of_words(ROWS.dtype) == {"step": 0, "speed": 1}


def test_fields_out_of_order_have_the_column_of_their_place() -> None:
    dtype = np.dtype({"names": ["b", "a"], "formats": ["f8", "f8"], "offsets": [8, 0]})
    assert columns_of_words(dtype) == {"b": 1, "a": 0}


def test_rows_at_odd_places_are_gathered_field_by_field() -> None:
    dtype = np.dtype({"names": ["a", "b"], "formats": ["f8", "f8"], "offsets": [4, 12]})
    rows = np.zeros(2, dtype)
    rows["a"], rows["b"] = [1.0, 2.0], [3.0, 4.0]
    words = words_of(rows).view(np.float64)
    places = columns_of_words(dtype)
    assert words[:, places["a"]].tolist() == [1.0, 2.0]
    assert words[:, places["b"]].tolist() == [3.0, 4.0]


def test_times_are_split_into_seconds_and_nanoseconds() -> None:
    step = np.array([(7, 3_000_000_001)], [("step", "i8"), ("time_ns", "i8")])
    heads = heads_of(step, np.array([0.5]))
    assert heads[0, :4].tolist() == [7, 3_000_000_001, 3, 1]
    assert heads[0, 4:].view(np.float64).tolist() == [0.5]


def test_slots_by_their_source_and_width() -> None:
    template = Template().word(1, "speed").slot("seconds", VARINT_WIDTH).slot("own", 4)
    form = message_form(template, {"speed": [1]}, {"own": [4]})
    assert form.slots.tolist() == [[1, 1]]  # behind a tag of one byte: column 1 of the rows
    assert form.odd_slots.tolist() == [[9, SECONDS, 5, 1], [14, 4, 4, 0]]
    assert len(form) == 18


def test_slots_of_one_name_have_a_column_each_or_one_for_all() -> None:
    template = Template().slot("place", 8).slot("place", 8).slot("clock", 8)
    assert message_form(template, {"place": [2, 5]}, {}).slots.tolist() == [[0, 2], [8, 5]]
    assert message_form(template, {"place": [2]}, {}).slots.tolist() == [[0, 2], [8, 2]]
    with pytest.raises(ValueError, match="zip"):
        message_form(template, {"place": [1, 2, 3]}, {})
    assert NANOS == 3
