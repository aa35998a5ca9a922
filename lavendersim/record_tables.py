"""Tables of records, moved as bytes: numpy itself copies and joins records field by field.

Of 26 columns that takes nine times as long as the bytes do.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


# What a row of a step or of a contact needs behind it for its time, so that none is copied for it.
ROOM_FOR_TIME: Final = 8  # [byte]


def copied(table: NDArray[Any], room: bool = False) -> NDArray[Any]:
    """Return a copy of a table (n, ..), with what stands in the room behind its rows.

    room: with a row of zeros in front of the first.
    """
    import numpy as np

    given = np.ascontiguousarray(table)
    row, rows = given.itemsize * math.prod(given.shape[1:]), len(given) + room
    whole = np.empty(rows * row, np.uint8)
    whole[: room * row] = 0
    whole[room * row :] = given.reshape(-1).view(np.uint8)
    return whole.view(given.dtype).reshape(rows, *given.shape[1:])


def joined(tables: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Return the rows of tables of one dtype, one after the other; one table as it is."""
    import numpy as np

    if len(tables) == 1:
        return tables[0]
    row = tables[0].dtype
    if any(table.dtype != row for table in tables):
        raise TypeError("tables of different columns")
    return np.concatenate([_as_bytes(table) for table in tables]).view(row)


def widened(table: NDArray[Any], row: np.dtype[Any]) -> NDArray[Any]:
    """Return a table of a dtype that begins with the fields of this one; the others are not set."""
    import numpy as np

    wide = np.empty(len(table), row)
    widen(table, wide)
    return wide


def widen(table: NDArray[Any], wide: NDArray[Any]) -> None:
    """Copy a table into one of as many rows, of a dtype that begins with its fields."""
    import numpy as np

    row, size = wide.dtype, table.dtype.itemsize
    _check_places(table.dtype, row)
    wide.view(np.uint8).reshape(len(table), row.itemsize)[:, :size] = (
        np.ascontiguousarray(_as_bytes(table)).view(np.uint8).reshape(len(table), size)
    )


@lru_cache(maxsize=256)
def with_room(row: np.dtype[Any], room: int = ROOM_FOR_TIME) -> np.dtype[Any]:
    """Return the dtype of the same fields with more behind each row [byte]."""
    import numpy as np

    fields: Mapping[str, Any] = row.fields or {}
    return np.dtype(
        {
            "names": [*fields],
            "formats": [place[0] for place in fields.values()],
            "offsets": [place[1] for place in fields.values()],
            "itemsize": row.itemsize + room,
        }
    )


@lru_cache(maxsize=256)
def _check_places(narrow: np.dtype[Any], wide: np.dtype[Any]) -> None:
    for name, place in (narrow.fields or {}).items():
        if wide.fields is None or wide.fields[name][:2] != place[:2]:
            raise TypeError(f"column {name} has another place")


def _as_bytes(table: NDArray[Any]) -> NDArray[Any]:
    return table.view(f"V{table.dtype.itemsize}")
