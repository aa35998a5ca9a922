"""Tables as files: what is read back, what stays where one fails, and the memory it takes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import csv, parquet

from lavendersim.arrow import Batch, Field, Table
from lavendersim.arrow.files import FORMATS, write_tables

FIELDS = (
    Field("count", "i8", "how many"),
    Field("depth", "f8", "how deep", "m"),
    Field("body", "word", "name", words=("floor", '<ball>, "red"')),
    Field("row", "numbers", "several"),
)


def batches() -> Iterator[Batch]:
    for first in range(3):
        yield {
            "count": np.arange(4) + 4 * first,
            "depth": np.array([np.nan, np.inf, -np.inf, 0.1 + first]),
            "body": np.array([0, 1, 0, 1]),
            "row": [[1.0], [], None, [0.1, 0.2]],
        }


TABLE = Table("made", FIELDS, batches)


def read(file: Path) -> Any:
    if file.suffix == ".parquet":
        return parquet.read_table(file)
    return pa.ipc.open_file(file).read_all()


@pytest.mark.parametrize("file_format", ["parquet", "arrow"])
def test_a_file_has_the_table_with_its_units(file_format: str, tmp_path: Path) -> None:
    (file,) = write_tables([TABLE], file_format, tmp_path)
    found = read(file)
    assert file == tmp_path / f"made.{file_format}"
    assert found.schema.field("depth").metadata[b"unit"] == b"m"
    for name in ("count", "body", "row"):
        assert found[name].to_pylist() == pa.table(TABLE)[name].to_pylist()
    assert found["depth"].to_numpy().tobytes() == pa.table(TABLE)["depth"].to_numpy().tobytes()
    assert pa.types.is_dictionary(found.schema.field("body").type)


def test_csv_has_all_digits_and_its_types_stand_beside_it(tmp_path: Path) -> None:
    file, described = write_tables([TABLE], "csv", tmp_path)
    found = csv.read_csv(file)
    np.testing.assert_array_equal(found["depth"].to_numpy(), pa.table(TABLE)["depth"].to_numpy())
    assert found["body"].to_pylist()[:2] == ["floor", '<ball>, "red"']
    assert found["row"].to_pylist()[:2] == ["[1.0]", "[]"]
    columns = json.loads(described.read_text())["tableSchema"]["columns"]
    assert [one["datatype"] for one in columns] == ["long", "double", "string", "json"]
    assert columns[1]["schema:unitText"] == "m"


@pytest.mark.parametrize("file_format", FORMATS)
def test_where_one_table_fails_every_earlier_file_stays(file_format: str, tmp_path: Path) -> None:
    write_tables([TABLE], file_format, tmp_path)
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}

    def broken() -> Iterator[Batch]:
        yield from batches()
        raise OSError(28, "No space left on device")

    other = Table("made", FIELDS[:1], lambda: iter([{"count": np.arange(2)}]))
    with pytest.raises(OSError, match="No space left"):
        write_tables([other, Table("second", FIELDS, broken)], file_format, tmp_path)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_row_groups_hold_many_batches(tmp_path: Path) -> None:
    """A group for each of ten thousand short cells would be more description than rows."""
    (file,) = write_tables([TABLE], "parquet", tmp_path)
    assert parquet.ParquetFile(file).num_row_groups == 1
