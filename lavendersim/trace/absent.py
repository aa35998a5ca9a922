"""The empty table of a topic that a log does without.

The table is empty, so whatever counts or loops over its rows needs to know nothing; whatever asks
for one of its columns gets that sentence as the reason.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lavendersim.errors import UsageError


class AbsentTable(np.ndarray[Any, Any]):
    """No rows and no columns. UsageError where a column is asked for."""

    why: str = ""

    def __array_finalize__(self, source: Any) -> None:
        """Pass the sentence on to what is cut out of the table."""
        self.why = getattr(source, "why", "")

    def __getitem__(self, key: Any) -> Any:
        """Return rows by number, slice or mask; there is no column to return."""
        if isinstance(key, str) or (isinstance(key, list) and key and isinstance(key[0], str)):
            raise UsageError(self.why)
        return super().__getitem__(key)


def absent_table(why: str) -> NDArray[Any]:
    """Return the empty table that gives `why` as its reason."""
    table = np.zeros(0, []).view(AbsentTable)
    table.why = why
    return table
