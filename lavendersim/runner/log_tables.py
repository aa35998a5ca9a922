"""The tables of all cells of a run as one: each log's rows behind the number and label of its cell.

cell  label     step  time  ...          one log after the other, part by part; columns are
0     e=0.2     0     0.0   ...          those of all logs together, null where a log has
1     e=0.5     0     0.0   ...          no such column
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from lavendersim.arrow import Batch, Field, Table
from lavendersim.errors import TraceError, UsageError

if TYPE_CHECKING:
    from .run_directory import Run, RunCell


def log_table(run: Run, name: str) -> Table:
    """Return a table of the logs of a run. UsageError where none of them has its topic.

    TraceError where a log is damaged, unless what is whole of it is allowed; then one of which
    nothing is whole has no rows.
    """
    columns: dict[str, Field] = {}
    words: dict[str, dict[str, int]] = {}  # of a column its words of all cells, by their places
    reasons: list[str] = []
    for cell in run.cells:
        if (own := _own_table(cell, name, reasons)) is None:
            continue
        for field in own.fields:
            columns.setdefault(field.name, field)
            places = words.setdefault(field.name, {})
            for word in field.words:
                places.setdefault(word, len(places))
        cell.release()
    if not columns:
        raise UsageError(reasons[0] if reasons else f"{run.path}: no log has a table {name!r}")
    fields = [field._replace(words=tuple(words[field.name])) for field in columns.values()]

    def batches() -> Iterator[Batch]:
        for place, cell in enumerate(run.cells):
            if (own := _own_table(cell, name, [])) is None:
                continue
            changed = {
                field.name: np.array([words[field.name][word] for word in field.words], np.int64)
                for field in own.fields
                if field.kind == "word"
            }
            for batch in own.batches():
                yield _of_cell(batch, changed, cell.index, place)
            cell.release()

    return Table(name, [*key_fields(run), *fields], batches)


def key_fields(run: Run) -> list[Field]:
    """Return the columns that say which cell a row is of."""
    labels = tuple(cell.label for cell in run.cells)
    return [
        Field("cell", "i8", "number of the cell in the sweep, from 0"),
        Field("label", "word", "coordinates of the cell in the sweep", words=labels),
    ]


def _own_table(cell: RunCell, name: str, reasons: list[str]) -> Table | None:
    """Return the table of a cell's log; None, and a reason, where it has no such."""
    try:
        return cell.trace().table(name)
    except UsageError as error:
        reasons.append(str(error))
    except TraceError as error:
        if not cell.allow_incomplete:
            raise
        reasons.append(str(error))
    cell.release()
    return None


def _of_cell(batch: Batch, changed: dict[str, Any], index: int, place: int) -> Batch:
    """Return rows of a log with their key, their words by the places in all logs' words."""
    rows = len(next(iter(batch.values())))
    return {
        "cell": np.full(rows, index, np.int64),
        "label": np.full(rows, place, np.int32),
        **{
            name: _renumbered(column, changed[name]) if name in changed else column
            for name, column in batch.items()
        },
    }


def _renumbered(codes: Any, places: Any) -> Any:
    known = (codes >= 0) & (codes < len(places))
    return np.where(known, places[np.where(known, codes, 0)], -1)
