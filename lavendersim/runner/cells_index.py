"""The index of a run, `cells.json`, as typed records: read and written here and nowhere else.

A row says of a cell of the sweep which log is its own, how it ended, and by digests what was
written. How cells ended while the run goes on stands beside it, see `run_index`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from lavendersim.config_options import ConfigOptions
from lavendersim.durable_files import write_in_pieces
from lavendersim.errors import TraceError

from .run_index import ENDED, PENDING, as_row, digest_of, ended_rows
from .run_tables import read_table

if TYPE_CHECKING:
    from lavendersim.trace import ExpectedLog, LogDigest


_RATIO: Final = re.compile(r"-?\d+/\d*[1-9]\d*")


@dataclass(frozen=True, slots=True)
class IndexRow:
    """What the index says of a cell."""

    index: int  # in the sweep
    label: str
    file: str  # its log, from the run's directory: `cells/NAME.mcap`
    status: str = PENDING  # how it ended
    config: str = ""  # SHA-256 of its resolved config; empty where an older version wrote it
    log: LogDigest | None = None  # of its log once that is closed
    coordinates: Mapping[str, Any] = field(default_factory=dict)  # by the axes, as JSON has them

    @property
    def expected(self) -> ExpectedLog:
        """What its log has to be."""
        from lavendersim.trace import ExpectedLog  # late, as is all of the trace

        return ExpectedLog(self.config, self.log)

    @property
    def as_json(self) -> dict[str, Any]:
        """The row as the file has it."""
        return {
            "index": self.index,
            "label": self.label,
            "coordinates": dict(self.coordinates),
            "file": self.file,
            "status": self.status,
            "config": self.config,
            "log": as_row(self.log),
        }


class CellsIndex(NamedTuple):
    """The index of a run."""

    experiment: str  # the stem of the file that it was read from
    question: str  # empty where the config asks none, and of older runs
    options: ConfigOptions
    cells: Iterable[IndexRow]  # in the order of the sweep; read, a tuple
    has_digests: bool = True  # older versions kept none of the logs


def write_index(path: Path, index: CellsIndex) -> None:
    """Write an index; its rows are made while they are written."""
    from .json_table import pieces_of  # late: who lists runs writes none

    options = index.options.row
    if not index.options.overrides:
        del options["overrides"]  # as in earlier versions
    table = {
        "experiment": index.experiment,
        "question": index.question,
        **options,
        "cells": (row.as_json for row in index.cells),
    }
    write_in_pieces(path, pieces_of(table), flush=False)


def read_index(path: Path) -> CellsIndex:
    """Return the index of a run. TraceError where it is damaged."""
    table = read_table(path, "cells", ("index", "label", "file", "status"))
    rows = table["cells"]
    try:
        return CellsIndex(
            str(table["experiment"]),
            str(table.get("question", "")),
            ConfigOptions.of_row(ConfigOptions().row | table),
            tuple(map(_row_of, rows)),
            any("log" in row for row in rows),
        )
    except KeyError as error:
        raise TraceError(f"{path}: damaged: it has no {error}") from None
    except (ValueError, TypeError) as error:
        raise TraceError(f"{path}: damaged: {error}") from None


def with_ended(rows: Iterable[IndexRow], directory: Path) -> Iterator[IndexRow]:
    """Yield the rows of a run that goes on, or was killed, with how its cells ended so far.

    TraceError where the file that says so is damaged.
    """
    try:
        ended = ended_rows(directory)
        for row in rows:
            one = ended.get(Path(row.file).name)
            if one is None:
                yield row
            else:
                yield replace(row, status=one["status"], log=digest_of(one["log"]))
    except (ValueError, KeyError, TypeError) as error:
        raise TraceError(f"{directory / ENDED}: damaged: {error}") from None


def _row_of(row: Mapping[str, Any]) -> IndexRow:
    for key in ("label", "file", "status"):
        if not isinstance(row[key], str):
            raise TypeError(f"{key} of a cell is no text: {row[key]!r}")
    return IndexRow(
        row["index"],
        row["label"],
        row["file"],
        row["status"],
        row.get("config", ""),
        digest_of(row.get("log")),
        row["coordinates"] if "coordinates" in row else _in_label(row["label"]),
    )


def swept_values(coordinates: Mapping[str, Any]) -> dict[str, Any]:
    """Return coordinates of the index as a sweep has them: JSON has ratios as texts."""
    return {
        axis: Fraction(value) if isinstance(value, str) and _RATIO.fullmatch(value) else value
        for axis, value in coordinates.items()
    }


def _in_label(label: str) -> dict[str, Any]:
    """Return the coordinates that a label names: the first versions kept no others."""
    parts = (part.split("=", 1) for part in label.split(", ") if "=" in part)
    return {axis: _value(text) for axis, text in parts}


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text
