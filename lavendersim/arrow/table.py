"""A table that is handed on by the Arrow C stream interface, batch by batch.

Whoever knows that interface reads it as it stands: `pyarrow.table(table)`,
`polars.DataFrame(table)`, `SELECT ... FROM table` in DuckDB. Every reader begins at the first
batch; one batch is in memory.
https://arrow.apache.org/docs/format/CDataInterface/PyCapsuleInterface.html
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from lavendersim.arrow.fields import Field
from lavendersim.errors import UsageError

# Of some rows every column by its name; None, or no entry, where these rows have no such column.
Batch = Mapping[str, Any]


class Table:
    """Columns with their meanings, and rows in batches."""

    def __init__(
        self, name: str, fields: Sequence[Field], batches: Callable[[], Iterator[Batch]]
    ) -> None:
        """batches: begins anew with each reader; a column of each batch is there, and counts it."""
        self.name = name
        self.fields = tuple(fields)
        self.batches = batches

    def schema(self) -> Any:
        """Return the columns as a `pyarrow.Schema`; each has `unit` and `meaning` as metadata."""
        pa = require_pyarrow()
        return pa.schema(
            [
                pa.field(
                    field.name,
                    _type(pa, field),
                    metadata={"unit": field.unit, "meaning": field.meaning},
                )
                for field in self.fields
            ],
            metadata={"table": self.name},
        )

    def reader(self) -> Any:
        """Return the rows from the first as a `pyarrow.RecordBatchReader`."""
        pa = require_pyarrow()
        schema = self.schema()
        words = {
            field.name: pa.array(field.words, pa.string())
            for field in self.fields
            if field.kind == "word"
        }
        return pa.RecordBatchReader.from_batches(
            schema, (self._record_batch(pa, schema, words, batch) for batch in self.batches())
        )

    def _record_batch(self, pa: Any, schema: Any, words: Mapping[str, Any], batch: Batch) -> Any:
        rows = len(next(column for column in batch.values() if column is not None))
        columns = [
            pa.nulls(rows, schema.field(field.name).type)
            if batch.get(field.name) is None
            else _array(pa, field, batch[field.name], words)
            for field in self.fields
        ]
        return pa.RecordBatch.from_arrays(columns, schema=schema)

    def __arrow_c_schema__(self) -> object:
        """Return the columns as the Arrow interface has them."""
        return self.schema().__arrow_c_schema__()

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """Return the rows as the Arrow interface has them; UsageError without pyarrow."""
        return self.reader().__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return f"<table {self.name}: {', '.join(field.name for field in self.fields)}>"


def require_pyarrow() -> Any:
    """Return pyarrow. UsageError where it is not installed."""
    try:
        import pyarrow
    except ImportError:
        raise UsageError(
            "tables need pyarrow, install it with: pip install 'lavendersim[arrow]'"
        ) from None
    return pyarrow


def _type(pa: Any, field: Field) -> Any:
    types = {
        "i8": pa.int64(),
        "u8": pa.uint64(),
        "f8": pa.float64(),
        "bool": pa.bool_(),
        "text": pa.string(),
        "word": pa.dictionary(pa.int32(), pa.string()),
        "numbers": pa.list_(pa.float64()),
        "texts": pa.list_(pa.string()),
    }
    return types[field.kind]


def _array(pa: Any, field: Field, values: Any, words: Mapping[str, Any]) -> Any:
    """Return a column of a batch. NaN and infinities stay numbers: null is what is not there."""
    if field.kind == "word":
        codes = np.asarray(values)
        unknown = (codes < 0) | (codes >= len(field.words))
        indices = pa.array(np.where(unknown, 0, codes).astype(np.int32), mask=unknown)
        return pa.DictionaryArray.from_arrays(indices, words[field.name])
    if isinstance(values, np.ndarray):
        return pa.array(np.ascontiguousarray(values), _type(pa, field), from_pandas=False)
    return pa.array(values, _type(pa, field), from_pandas=False)
