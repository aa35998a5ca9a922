"""The tables of a run as JSON: read where they are as written, under their present names."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from lavendersim.errors import TraceError

from .run_seal import read_sealed

# Keys of the tables of older runs, and their names now.
FORMER_NAMES: Final = {
    "unsolved_steps": "not_converged_steps",
    "prices": "overheads",
    "price": "overhead",
    "called_for": "required",
}


def read_table(path: Path, rows: str, keys: Sequence[str] = ()) -> dict[str, Any]:
    """Return a table that lavender wrote. TraceError where it is damaged.

    It has `rows`, and each of these has `keys`; of older runs no digest says so.
    """
    try:
        table: Any = json.loads(read_sealed(path))
    except (ValueError, RecursionError) as error:
        raise TraceError(f"{path}: damaged: {error}") from None
    found = table.get(rows) if isinstance(table, dict) else None
    if not isinstance(found, list) or not all(
        isinstance(row, dict) and row.keys() >= set(keys) for row in found
    ):
        raise TraceError(f"{path}: damaged: it has no table {rows!r}")
    return dict(table)


def renamed(table: dict[str, Any], rows: str) -> dict[str, Any]:
    """Return a table with the columns of older runs under the names that they have now."""
    _rename(table)
    overheads = table.get("overheads") or {"rows": []}
    for row in (*table[rows], *overheads["rows"], table.get("truth") or {}):
        _rename(row)
    return table


def _rename(row: dict[str, Any]) -> None:
    for former, name in FORMER_NAMES.items():
        if former in row:
            row[name] = row.pop(former)
    if row.get("role") == "stated":
        row["role"] = "specified"
