"""Tables that were written as plain data, read as the dataclasses that they are of."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

Record = TypeVar("Record")
_adapter: Callable[[Any], TypeAdapter[Any]] = cache(TypeAdapter)  # made once a dataclass


def read_as(kind: type[Record], data: object) -> Record:
    """Return plain data as a dataclass. ValueError, with the place, where it does not fit."""
    try:
        found: Record = _adapter(kind).validate_python(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise ValueError(f"{place}: {first['msg'].lower()}") from None
    return found


def plain(record: Any) -> dict[str, Any]:
    """Return a dataclass as the plain data that JSON has."""
    data: dict[str, Any] = _adapter(type(record)).dump_python(record, mode="json")
    return data
