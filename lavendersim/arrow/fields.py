"""Columns of a table: name, kind, unit, meaning, and the words of a column that repeats few."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

# Numbers as numpy has them; `word` is one of a column's `words`, by its index.
Kind = Literal["i8", "u8", "f8", "bool", "text", "word", "numbers", "texts"]
NUMBERS: dict[str, Kind] = {"i8": "i8", "u8": "u8", "f8": "f8"}
_UNIT = re.compile(r"\s*\[(?P<unit>[^\]]*)\]")


class Field(NamedTuple):
    """One column. unit: `-` of a ratio, empty where the column has none (a name, a number of)."""

    name: str
    kind: Kind
    meaning: str = ""
    unit: str = ""
    words: tuple[str, ...] = ()


def described(name: str, kind: Kind, text: str, words: tuple[str, ...] = ()) -> Field:
    """Return a column whose meaning has its unit in brackets: `signed distance [m]`."""
    found = _UNIT.search(text)
    if found is None:
        return Field(name, kind, text, "", words)
    return Field(name, kind, _UNIT.sub("", text, count=1).strip(), found["unit"], words)


def distinct(groups: dict[str, list[Field]]) -> list[Field]:
    """Return the columns of all groups; a name taken by an earlier group gets its group before it.

    A sweep may have an axis, and a config a measure, that is called `status`.
    """
    taken: set[str] = set()
    fields: list[Field] = []
    for group, members in groups.items():
        for field in members:
            name = field.name
            while name in taken:
                name = f"{group}_{name}"
            taken.add(name)
            fields.append(field._replace(name=name))
    return fields
