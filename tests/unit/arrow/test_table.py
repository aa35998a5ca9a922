"""A table as programs of others read it: every number to the bit, every column with its unit."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import duckdb
import numpy as np
import pyarrow as pa
import pytest

from lavendersim.arrow import Batch, Field, Table, described
from lavendersim.arrow.fields import distinct
from lavendersim.errors import UsageError

NUMBERS = np.array([0.0, -0.0, np.nan, np.inf, -np.inf, 5e-324, 0.1])
COUNTS = np.array([2**63 - 1, -(2**63), 0, 1, 2, 3, 2**53 + 1])
HASHES = np.array([2**64 - 1, 0, 1, 2, 3, 4, 5], np.uint64)
FIELDS = (
    Field("count", "i8", "how many"),
    Field("hash", "u8"),
    described("depth", "f8", "how deep [m], negative outside"),
    Field("body", "word", words=("floor", "ball")),
    Field("missing", "f8"),
)


def batches() -> Iterator[Batch]:
    rows = {"count": COUNTS, "hash": HASHES, "depth": NUMBERS, "body": np.array([0, 1] * 3 + [-1])}
    yield rows
    yield {**{name: column[:2] for name, column in rows.items()}, "missing": np.array([1.0, 2.0])}


TABLE = Table("made", FIELDS, batches)


def test_numbers_are_handed_on_to_the_bit_and_integers_stay_integers() -> None:
    read = pa.table(TABLE)
    assert [str(column.type) for column in read.columns[:3]] == ["int64", "uint64", "double"]
    depths = read["depth"].to_numpy()[: len(NUMBERS)]
    assert depths.tobytes() == NUMBERS.tobytes()
    assert read["depth"].null_count == 0  # NaN is a number, null is none
    assert read["count"].to_pylist()[: len(COUNTS)] == COUNTS.tolist()
    assert read["hash"].to_pylist()[: len(HASHES)] == HASHES.tolist()


def test_what_rows_do_not_have_is_null() -> None:
    assert pa.table(TABLE)["missing"].to_pylist() == [None] * 7 + [1.0, 2.0]


def test_words_are_a_dictionary_and_an_index_outside_is_null() -> None:
    column = pa.table(TABLE)["body"]
    assert pa.types.is_dictionary(column.type)
    assert column.to_pylist() == ["floor", "ball"] * 3 + [None, "floor", "ball"]


def test_a_column_says_its_unit_and_meaning() -> None:
    metadata = TABLE.schema().field("depth").metadata
    assert metadata == {b"unit": b"m", b"meaning": b"how deep, negative outside"}
    assert pa.schema(TABLE) == TABLE.schema()


def test_every_reader_begins_at_the_first_row() -> None:
    first, second = pa.table(TABLE)["count"], pa.table(TABLE)["count"]
    assert first.to_pylist() == second.to_pylist() == [*COUNTS.tolist(), *COUNTS[:2].tolist()]


def test_batches_are_made_as_they_are_read() -> None:
    made: list[int] = []

    def endless() -> Iterator[Batch]:
        for number in range(1_000_000):
            made.append(number)
            yield {"count": np.array([number])}

    reader = Table("endless", FIELDS[:1], endless).reader()
    assert reader.read_next_batch()["count"].to_pylist() == [0]
    assert len(made) <= 2


def test_duckdb_reads_it_by_the_arrow_interface_alone() -> None:
    class OnlyTheInterface:
        def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
            return TABLE.__arrow_c_stream__(requested_schema)

    rows = OnlyTheInterface()  # noqa: F841 - DuckDB finds it by its name
    found = duckdb.sql("SELECT body, max(count) FROM rows GROUP BY body ORDER BY body").fetchall()
    # The floor has rows 0, 2, 4 and again 0; the ball 1, 3, 5 and again 1.
    assert found == [("ball", 3), ("floor", 2**63 - 1), (None, 2**53 + 1)]


def test_polars_reads_it_by_the_arrow_interface() -> None:
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(TABLE)
    assert frame["depth"].to_numpy()[: len(NUMBERS)].tobytes() == NUMBERS.tobytes()
    assert frame["hash"].to_list()[: len(HASHES)] == HASHES.tolist()
    assert frame["body"].to_list() == ["floor", "ball"] * 3 + [None, "floor", "ball"]
    assert frame["missing"].null_count() == 7


def test_pandas_reads_it_by_the_arrow_interface() -> None:
    pandas = pytest.importorskip("pandas", minversion="3.0")
    frame = pandas.DataFrame.from_arrow(TABLE)
    assert frame["depth"].to_numpy()[: len(NUMBERS)].tobytes() == NUMBERS.tobytes()
    assert frame["count"].to_list()[: len(COUNTS)] == COUNTS.tolist()
    assert frame["body"].to_list()[:2] == ["floor", "ball"]
    assert frame["missing"].isna().sum() == 7


def test_without_pyarrow_a_sentence_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(UsageError, match=r"pip install 'lavendersim\[arrow\]'"):
        TABLE.__arrow_c_stream__()


def test_a_name_that_is_taken_gets_its_group_before_it() -> None:
    groups = {"cell": [Field("status", "text")], "measure": [Field("status", "f8")]}
    assert [field.name for field in distinct(groups)] == ["status", "measure_status"]
