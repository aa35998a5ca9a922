"""Tables for programs of others, by Arrow: typed columns with unit and meaning, in batches.

The only room that knows pyarrow, which is an extra; it is imported when a table is handed on.

    Field      a column: name, kind, unit, meaning
    Table      fields, and batches that are made as they are asked for; `__arrow_c_stream__`
    files      tables written as Parquet, CSV or Arrow files, batch by batch
"""

from lavendersim.arrow.fields import Field, Kind, described
from lavendersim.arrow.table import Batch, Table, require_pyarrow

__all__ = ["Batch", "Field", "Kind", "Table", "described", "require_pyarrow"]
