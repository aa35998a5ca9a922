"""Tables as JSON that people can read: a key a line, and of a list of rows a row a line.

The standard library's indented form is written by Python code, some thirty times slower.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Final

_encode: Final = json.JSONEncoder(allow_nan=False).encode
_PLAIN: Final = frozenset({str, int, bool, type(None)})


def text_of(table: Mapping[str, Any]) -> str:
    """Return a table as text. ValueError for a number that JSON does not have."""
    return "".join(pieces_of(table))


def pieces_of(
    table: Mapping[str, Any], instead: Callable[[float], Any] | None = None
) -> Iterator[str]:
    """Yield the same text in pieces: of many cells the whole is larger than what it is made of.

    A list of rows may be an iterator, whose rows are made as they are written. instead: what rows
    have for a number that JSON does not have; without it such a number is a ValueError.
    """
    yield "{\n"
    between = ""
    for key, value in table.items():
        yield f"{between} {_encode(key)}: "
        yield from _rows(value, instead) if _is_of_rows(value) else (_encode(value),)
        between = ",\n"
    yield "\n}\n"


def finite(value: Any, instead: Callable[[float], Any]) -> Any:
    """Return `value` with something instead of every number that JSON does not have."""
    if isinstance(value, float):
        return value if math.isfinite(value) else instead(value)
    if isinstance(value, list):
        return [finite(item, instead) for item in value]
    if isinstance(value, dict):  # most of a row is neither, and asked here
        return {
            key: item if type(item) in _PLAIN else finite(item, instead)
            for key, item in value.items()
        }
    return value


def _is_of_rows(value: Any) -> bool:
    if isinstance(value, list):
        return bool(value) and all(isinstance(row, dict) for row in value)
    return isinstance(value, Iterator)


def _rows(
    rows: Iterable[Mapping[str, Any]], instead: Callable[[float], Any] | None
) -> Iterator[str]:
    between = "[\n"
    for row in rows:
        try:
            text = _encode(row)
        except ValueError:  # few have such a number, and to look for one takes longer
            if instead is None:
                raise
            text = _encode(finite(row, instead))
        yield f"{between}  {text}"
        between = ",\n"
    yield "\n ]" if between == ",\n" else "[]"
