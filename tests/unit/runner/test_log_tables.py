"""The logs of a run as one table: rows behind their cell, words renumbered, columns united."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.arrow import Field, Table
from lavendersim.errors import TraceError, UsageError
from lavendersim.runner.log_tables import log_table

X, EXTRA = Field("x", "f8"), Field("extra", "f8")


def body(*words: str) -> Field:
    return Field("body", "word", words=words)


def cell(index: int, *batches: dict[str, Any], fields: tuple[Field, ...] = (X,), error: Exception | None = None) -> Any:  # noqa: E501  # fmt: skip
    def own(name: str) -> Table:
        if error is not None:
            raise error
        return Table(name, fields, lambda: iter(batches))

    released: list[int] = []
    return SimpleNamespace(
        index=index,
        label=f"e={index}",
        trace=lambda: SimpleNamespace(table=own),
        release=lambda: released.append(1),
        released=released,
        allow_incomplete=False,
    )


def run(*cells: Any) -> Any:
    return SimpleNamespace(cells=list(cells), path=Path("run"))


def rows(table: Table) -> list[dict[str, Any]]:
    return [{k: np.asarray(v).tolist() for k, v in batch.items()} for batch in table.batches()]


def test_rows_stand_behind_number_and_label_part_by_part() -> None:
    first = cell(4, {"x": np.array([1.0, 2.0])}, {"x": np.array([3.0])})
    second = cell(9, {"x": np.array([5.0])})
    table = log_table(run(first, second), "step")
    assert [field.name for field in table.fields] == ["cell", "label", "x"]
    assert table.fields[1].words == ("e=4", "e=9")
    assert rows(table) == [
        {"cell": [4, 4], "label": [0, 0], "x": [1.0, 2.0]},
        {"cell": [4], "label": [0], "x": [3.0]},
        {"cell": [9], "label": [1], "x": [5.0]},
    ]
    assert rows(table) == rows(table)  # every reader begins at the first row
    assert first.released


def test_columns_are_those_of_all_logs_together() -> None:
    first = cell(0, {"x": np.array([1.0])})
    second = cell(1, {"x": np.array([2.0]), "extra": np.array([3.0])}, fields=(X, EXTRA))
    table = log_table(run(first, second), "step")
    assert [field.name for field in table.fields] == ["cell", "label", "x", "extra"]
    assert "extra" not in rows(table)[0]


def test_words_are_the_same_words_by_other_numbers() -> None:
    fields = (body("floor", "ball"),), (body("floor", "crate", "ball"),)
    codes = np.array([0, 1, -1]), np.array([0, 1, 2, 7])
    cells = [cell(k, {"body": codes[k]}, fields=fields[k]) for k in (0, 1)]
    table = log_table(run(*cells), "contact")
    words = table.fields[2].words
    assert words == ("floor", "ball", "crate")
    found = [[words[c] if c >= 0 else None for c in batch["body"]] for batch in rows(table)]
    assert found == [["floor", "ball", None], ["floor", "crate", "ball", None]]


def test_a_log_without_the_table_has_no_rows_and_all_of_them_a_reason() -> None:
    without = cell(0, error=UsageError("0.mcap: this log has no /contacts"))
    with_rows = cell(1, {"x": np.array([5.0])})
    assert [row["cell"] for row in rows(log_table(run(without, with_rows), "contact"))] == [[1]]
    with pytest.raises(UsageError, match="this log has no /contacts"):
        log_table(run(without, without), "contact")


def test_a_damaged_log_is_refused_unless_a_part_is_allowed() -> None:
    damaged = cell(0, error=TraceError("0.mcap: damaged"))
    with pytest.raises(TraceError, match="damaged"):
        log_table(run(damaged, cell(1, {"x": np.array([1.0])})), "step")
    damaged.allow_incomplete = True
    assert len(rows(log_table(run(damaged, cell(1, {"x": np.array([1.0])})), "step"))) == 1
