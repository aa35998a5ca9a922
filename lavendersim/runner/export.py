"""A run as tables for other programs: which there are, and as files in a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from lavendersim.arrow import Table, require_pyarrow
from lavendersim.arrow.files import FORMATS, write_tables
from lavendersim.errors import UsageError

from .log_tables import log_table
from .result_tables import cells_table, verdicts_table

if TYPE_CHECKING:
    from .run_directory import Run

__all__ = ["FORMATS", "TABLES", "Exported", "export_run", "table_of"]

_OF_RESULTS: Final[dict[str, Callable[[Run], Table]]] = {
    "cells": cells_table,
    "verdicts": verdicts_table,
}
_OF_LOGS: Final = ("step", "pose", "velocity", "contact")
_ASKED_FOR: Final = ("velocity",)  # a run has it where its config says so, and is else not blamed
TABLES: Final = (*_OF_RESULTS, *_OF_LOGS)


class Exported(NamedTuple):
    """What was written, and what not, each with a sentence why."""

    files: list[Path]
    left_out: list[str]


def table_of(run: Run, name: str) -> Table:
    """Return a table of a run. UsageError for a name of none, or where the run has none such."""
    if name in _OF_RESULTS:
        return _OF_RESULTS[name](run)
    if name not in _OF_LOGS:
        raise UsageError(f"{name!r}: no table of a run; expected one of {', '.join(TABLES)}")
    return log_table(run, name)


def export_run(
    run: Run, file_format: str, folder: Path, names: Sequence[str] | None = None
) -> Exported:
    """Write tables of a run as files of `folder`; without names all that the run has.

    Memory is that of some batches, however long the logs are. UsageError where pyarrow is missing,
    the format is none, or a table that was named is not there.
    """
    require_pyarrow()
    if file_format not in FORMATS:
        raise UsageError(f"{file_format!r}: expected one of {', '.join(FORMATS)}")
    tables: list[Table] = []
    left_out: list[str] = []
    for name in dict.fromkeys(TABLES if names is None else names):
        try:
            tables.append(table_of(run, name))
        except UsageError as error:
            if names is not None:
                raise
            if name not in _ASKED_FOR:
                left_out.append(f"no table {name}: {error}")
    return Exported(write_tables(tables, file_format, folder), left_out)
