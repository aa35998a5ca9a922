"""The empty table of a topic that a log does without; a table without some of its columns.

The table is empty, so whatever counts or loops over its rows needs to know nothing; whatever asks
for one of its columns gets that sentence as the reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lavendersim.errors import unanswerable


class AbsentTable(np.ndarray[Any, Any]):
    """No rows and no columns. UsageError where a column is asked for."""

    why: str = ""

    def __array_finalize__(self, source: Any) -> None:
        """Pass the sentence on to what is cut out of the table."""
        self.why = getattr(source, "why", "")

    def __getitem__(self, key: Any) -> Any:
        """Return rows by number, slice or mask; there is no column to return."""
        if isinstance(key, str) or (isinstance(key, list) and key and isinstance(key[0], str)):
            raise unanswerable(self.why)
        return super().__getitem__(key)


def absent_table(why: str) -> NDArray[Any]:
    """Return the empty table that gives `why` as its reason."""
    table = np.zeros(0, []).view(AbsentTable)
    table.why = why
    return table


class TableWithout(np.ndarray[Any, Any]):
    """A table whose engine does not report some columns; NotReportedError for one of them."""

    why: Mapping[str, str] = MappingProxyType({})  # by column

    def __array_finalize__(self, source: Any) -> None:
        """Pass the reasons on to what is cut out of the table."""
        self.why = getattr(source, "why", MappingProxyType({}))

    def __getitem__(self, key: Any) -> Any:
        """Return rows, or columns by their names: these as plain arrays."""
        if isinstance(key, str):
            if key in self.why:
                raise unanswerable(self.why[key])
            return super().__getitem__(key).view(np.ndarray)
        return super().__getitem__(key)


def table_without(table: NDArray[Any], why: Mapping[str, str]) -> NDArray[Any]:
    """Return a table that gives the reasons of columns that it does without, if any."""
    if not why:
        return table
    found = table.view(TableWithout)
    found.why = why
    return found
