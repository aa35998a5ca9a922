"""Tables as JSON: the same data, a row a line."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest

from lavendersim.runner.json_table import pieces_of, text_of

TABLE = {
    "name": 'sweep "é"\n',
    "empty": [],
    "cells": [{"index": 0, "values": [1.5, None]}, {"index": 1, "values": [0.1, True]}],
    "mixed": [1, {"a": 2}],
    "nested": {"rows": [{"x": 1}]},
}


def test_a_table_is_read_back_as_it_was() -> None:
    assert json.loads(text_of(TABLE)) == TABLE


def test_each_row_stands_on_a_line_of_its_own() -> None:
    lines = text_of(TABLE).splitlines()
    assert [line for line in lines if '"index"' in line] == [
        '  {"index": 0, "values": [1.5, null]},',
        '  {"index": 1, "values": [0.1, true]}',
    ]


def test_what_json_has_no_number_for_is_refused() -> None:
    with pytest.raises(ValueError, match="JSON"):
        text_of({"worst": float("nan")})


@pytest.mark.parametrize("count", [0, 1, 3])
def test_rows_may_be_made_as_they_are_written(count: int) -> None:
    rows = [{"index": index} for index in range(count)]
    made = []

    def making() -> Iterator[dict[str, int]]:
        for row in rows:
            made.append(row)
            yield row

    table = {"cells": making(), "passed": True}
    pieces = pieces_of(table)
    text = ""
    for piece in pieces:
        text += piece
        assert len(made) - text.count("index") in (0, 1)  # one is made, the others are written
    assert text == text_of({"cells": rows, "passed": True})
    assert made == rows


def test_rows_have_something_instead_where_json_has_no_number() -> None:
    rows = [{"x": 1.0}, {"x": float("nan"), "deep": [{"y": float("-inf")}]}]
    text = "".join(pieces_of({"cells": rows}, str))
    assert json.loads(text) == {"cells": [{"x": 1.0}, {"x": "nan", "deep": [{"y": "-inf"}]}]}
