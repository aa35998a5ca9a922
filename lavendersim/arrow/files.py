"""Tables as files: Parquet, Arrow (the IPC file format) or CSV, batch by batch, then renamed.

CSV has no place for types, units and meanings: they stand beside it, in `TABLE.csv-metadata.json`
as the W3C's "Metadata Vocabulary for Tabular Data" has them. Lists are JSON there.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from lavendersim.arrow.fields import Field
from lavendersim.arrow.table import Table, require_pyarrow
from lavendersim.durable_files import write_whole, written_aside

# Rows of a Parquet row group: at 40 columns some 20 MB in memory. Readers skip whole groups, and a
# group for each of ten thousand short cells would be more description than rows.
ROWS_OF_A_GROUP: Final = 1 << 16

# Of a column's kind its type in CSV's metadata (XML Schema's names).
CSV_TYPES: Final = {"i8": "long", "u8": "unsignedLong", "f8": "double", "bool": "boolean"}
LISTS: Final = ("numbers", "texts")


def write_tables(tables: Sequence[Table], file_format: str, folder: Path) -> list[Path]:
    """Write each table to `folder/NAME.FORMAT` and return the files.

    All are written aside before the first takes its place, so what was there stays where anything
    fails. OSError with the name of the file.
    """
    require_pyarrow()
    write = WRITERS[file_format]
    files = [folder / f"{table.name}.{file_format}" for table in tables]
    with contextlib.ExitStack() as stack:
        for table, file in zip(tables, files, strict=True):
            try:
                write(table, stack.enter_context(written_aside(file)))
            except OSError as error:
                error.filename = str(file)
                raise
    if file_format != "csv":
        return files
    beside = [file.with_name(f"{file.name}-metadata.json") for file in files]
    for table, file, described in zip(tables, files, beside, strict=True):
        write_whole(described, _csv_metadata(table, file.name))
    return files + beside


def _write_parquet(table: Table, file: Path) -> None:
    from pyarrow import parquet

    reader = table.reader()
    with _opened(file) as sink, parquet.ParquetWriter(sink, reader.schema) as writer:
        for rows in _groups(reader, ROWS_OF_A_GROUP):
            writer.write_table(rows, row_group_size=ROWS_OF_A_GROUP)


def _write_arrow(table: Table, file: Path) -> None:
    pa = require_pyarrow()
    reader = table.reader()
    with _opened(file) as sink, pa.ipc.new_file(sink, reader.schema) as writer:
        for rows in _groups(reader, ROWS_OF_A_GROUP):
            writer.write_table(rows.combine_chunks())


def _write_csv(table: Table, file: Path) -> None:
    pa = require_pyarrow()
    from pyarrow import csv

    reader = table.reader()
    flat = pa.schema(
        [
            pa.field(one.name, pa.string()) if field.kind in (*LISTS, "word") else one
            for one, field in zip(reader.schema, table.fields, strict=True)
        ]
    )
    with _opened(file) as sink, csv.CSVWriter(sink, flat) as writer:
        for batch in reader:
            columns = [
                _text_of(pa, field, column)
                for field, column in zip(table.fields, batch.columns, strict=True)
            ]
            writer.write_batch(pa.RecordBatch.from_arrays(columns, schema=flat))


WRITERS: Final[dict[str, Callable[[Table, Path], None]]] = {
    "parquet": _write_parquet,
    "csv": _write_csv,
    "arrow": _write_arrow,
}
FORMATS: Final = tuple(WRITERS)


def _opened(file: Path) -> Any:
    return require_pyarrow().OSFile(str(file), "wb")


def _groups(reader: Iterable[Any], rows: int) -> Iterator[Any]:
    """Yield the batches as tables of at least so many rows, but for the last."""
    pa = require_pyarrow()
    waiting: list[Any] = []
    for batch in reader:
        waiting.append(batch)
        if sum(one.num_rows for one in waiting) >= rows:
            yield pa.Table.from_batches(waiting)
            waiting = []
    if waiting:
        yield pa.Table.from_batches(waiting)


def _text_of(pa: Any, field: Field, column: Any) -> Any:
    """Return a column as CSV can have it: words as texts, lists as JSON."""
    if field.kind == "word":
        return column.cast(pa.string())
    if field.kind in LISTS:
        texts = [None if one is None else json.dumps(one) for one in column.to_pylist()]
        return pa.array(texts, pa.string())
    return column


def _csv_metadata(table: Table, name: str) -> str:
    columns = [
        {
            "name": field.name,
            "titles": field.name,
            "datatype": CSV_TYPES.get(field.kind, "json" if field.kind in LISTS else "string"),
            "dc:description": field.meaning,
            **({"schema:unitText": field.unit} if field.unit else {}),
        }
        for field in table.fields
    ]
    described = {
        "@context": ["http://www.w3.org/ns/csvw", {"schema": "http://schema.org/"}],
        "url": name,
        "tableSchema": {"columns": columns},
    }
    return json.dumps(described, indent=1) + "\n"
