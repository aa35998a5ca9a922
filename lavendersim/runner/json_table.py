"""Tables as JSON that people can read: a key a line, and of a list of rows a row a line.

The standard library's indented form is written by Python code, some thirty times slower.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from typing import Any


def text_of(table: Mapping[str, Any]) -> str:
    """Return a table as text. ValueError for a number that JSON does not have."""
    return (
        "{\n" + ",\n".join(f" {_text(key)}: {_rows(one)}" for key, one in table.items()) + "\n}\n"
    )


def finite(value: Any, instead: Callable[[float], Any]) -> Any:
    """Return `value` with something instead of every number that JSON does not have."""
    if isinstance(value, float) and not math.isfinite(value):
        return instead(value)
    if isinstance(value, list):
        return [finite(item, instead) for item in value]
    if isinstance(value, dict):
        return {key: finite(item, instead) for key, item in value.items()}
    return value


def _rows(value: Any) -> str:
    if isinstance(value, list) and value and all(isinstance(row, dict) for row in value):
        return "[\n" + ",\n".join(f"  {_text(row)}" for row in value) + "\n ]"
    return _text(value)


def _text(value: Any) -> str:
    return json.dumps(value, allow_nan=False)
