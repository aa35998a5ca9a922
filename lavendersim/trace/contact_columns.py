"""Contacts of a group of steps, column by column: what `/contact_columns` holds of them.

From step to step most contacts persist, and their numbers agree in their first digits. So contacts
are put in the order of their keys (body_a, body_b, feature), those of one key by step; each number
is written as its bits xor those of the contact before of the same key; and bytes of equal weight
stand together, the first bytes of all numbers, then the second ones: what agrees is zero there, and
what does not is noise that no compression shortens. Keys are differences from row to row, in the
order of the steps, in which the engine finds contacts.

    keys     (k, n)     int64: key[i] - key[i - 1]
    planes   (8, m, n)  bytes of m columns in the order of keys, the heaviest byte first

The inverse needs no bit more: keys give the order back. A column that follows from others bit for
bit (`Column.derived`) is not stored where they are; the channel's metadata has its rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.engine.effects import EFFECTS, Derived
from lavendersim.trace.layout import bytes_field

DERIVED: dict[str, Derived] = {
    column.name: column.derived
    for effect in EFFECTS
    for column in effect.contact_columns
    if column.derived is not None
}
OF_THE_MESSAGE: Final = "step"  # the same for all contacts of a step
KEY: Final[tuple[str, ...]] = ("body_a", "body_b", "feature")
Integers = NDArray[np.int64]


class ColumnForm(NamedTuple):
    """Which columns of contacts are stored, and which a reader derives."""

    names: tuple[str, ...]
    kinds: tuple[str, ...]  # f8 or i8
    derived: tuple[str, ...]


@lru_cache(maxsize=64)
def column_form(row: np.dtype[Any]) -> ColumnForm:
    """Return the form of the columns of contacts; row: the engine's. TypeError for other kinds."""
    given = row.names or ()
    derived = tuple(name for name in given if name in DERIVED and _follows(name, given))
    names = tuple(name for name in given if name not in derived and name != OF_THE_MESSAGE)
    kinds = tuple(row[name].str[1:] for name in names)
    for name, kind in zip(names, kinds, strict=True):
        if kind not in ("f8", "i8"):
            raise TypeError(f"contact column {name!r} is {row[name]}; float64 or int64 needed")
    return ColumnForm(names, kinds, derived)


def _follows(name: str, columns: Iterable[str]) -> bool:
    return all(source in columns for source in DERIVED[name].sources)


def rules_of(form: ColumnForm) -> dict[str, str]:
    """Return the rule of every column that is not stored, as a log has it."""
    return {name: DERIVED[name].rule for name in form.derived}


def known_rules(rules: Mapping[str, str]) -> tuple[str, ...]:
    """Return the columns that a log leaves to these rules. ValueError for one of no effect here."""
    for name, rule in rules.items():
        if name not in DERIVED or DERIVED[name].rule != rule:
            raise ValueError(f"column {name} is left to a rule of another version: {rule}")
    return tuple(rules)


class ContactGroup(NamedTuple):
    """The contacts of some steps."""

    steps: Integers  # number of each step that is recorded
    times: Integers  # of each [ns]
    counts: Integers  # contacts of each
    rows: NDArray[Any]  # of all, one step after the other


def message_of(group: ContactGroup, form: ColumnForm) -> list[bytes | memoryview]:
    """Return the lavender.ContactColumns of some steps, in pieces."""
    packed = pack(group.rows, form.names)
    numbers = [column.astype("<i8").tobytes() for column in group[:3]]
    fields: list[tuple[bytes | memoryview, ...]] = [
        *((one,) for one in numbers),
        tuple(name.encode() for name in form.names),
        tuple(kind.encode() for kind in form.kinds),
        *((one,) for one in packed),
    ]
    pieces: list[bytes | memoryview] = []
    for number, parts in enumerate(fields, 1):
        for part in parts:
            pieces += [bytes_field(number, len(part)), part]
    return pieces


class Packed(NamedTuple):
    """The same as bytes."""

    keys: bytes | memoryview
    planes: bytes | memoryview


def pack(rows: NDArray[Any], names: tuple[str, ...]) -> Packed:
    """Return contacts as bytes; names: of the columns that are stored, each of eight bytes."""
    keys = _keys(rows, names)
    order, persists = _order(keys)
    words = np.empty((len(names) - len(keys), len(rows)), np.uint64)
    for number, name in enumerate(_numbers(names)):
        words[number] = np.ascontiguousarray(rows[name]).view(np.uint64)[order]
    before = np.where(persists[1:], words[:, :-1], np.uint64(0))
    words[:, 1:] ^= before
    planes = words[:, :, None].view(np.uint8)[:, :, ::-1].transpose(2, 0, 1)
    differences = np.diff(keys, axis=1, prepend=0)
    return Packed(differences.tobytes(), np.ascontiguousarray(planes).reshape(-1).data)


def unpack(packed: Packed, names: tuple[str, ...], table: NDArray[Any]) -> None:
    """Fill the columns of a table. ValueError where the bytes are not as many as it has rows."""
    count = len(table)
    known, numbers = [name for name in KEY if name in names], _numbers(names)
    keys = np.frombuffer(packed.keys, np.int64).reshape(len(known), count).cumsum(axis=1)
    order, persists = _order(keys)
    planes = np.frombuffer(packed.planes, np.uint8).reshape(8, len(numbers), count)
    heaviest_last = np.ascontiguousarray(planes[::-1].transpose(1, 2, 0))
    words = np.bitwise_xor.accumulate(heaviest_last.view(np.uint64)[:, :, 0], axis=1)
    # Each key begins anew: what went before it is taken out again.
    begins = np.maximum.accumulate(np.where(persists, 0, np.arange(count)))
    words ^= np.where(begins > 0, words[:, begins - 1], np.uint64(0))
    for name, key in zip(known, keys, strict=True):
        table[name] = key
    for number, column in zip(numbers, words, strict=True):
        table[number][order] = column.view(table.dtype[number])


def _numbers(names: tuple[str, ...]) -> list[str]:
    return [name for name in names if name not in KEY]


def _keys(rows: NDArray[Any], names: tuple[str, ...]) -> Integers:
    known = [np.asarray(rows[name], np.int64) for name in KEY if name in names]
    return np.stack(known) if known else np.empty((0, len(rows)), np.int64)


def _order(keys: Integers) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the rows in the order of keys, by step in each, and which follow one of their key."""
    count = keys.shape[1]
    order = np.lexsort(keys[::-1]) if len(keys) else np.arange(count)
    ordered, persists = keys[:, order], np.zeros(count, bool)
    if len(keys):
        persists[1:] = (ordered[:, 1:] == ordered[:, :-1]).all(axis=0)
    return order, persists
