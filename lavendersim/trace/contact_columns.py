"""Contacts of a group of steps, column by column: what `/contact_columns` holds of them.

From step to step most contacts persist, and their numbers agree in their first digits. So contacts
are put in the order of their keys (body_a, body_b, feature), those of one key by step; of each
number is written how its bits differ from what a predictor says, mostly by the contacts before of
the same key (`predictors`); and bytes of equal weight stand together, the first bytes of all
numbers, then the second ones: what agrees is zero there, and what does not is noise that no
compression shortens. Keys are differences from row to row, in the order of the steps, in which the
engine finds contacts.

    keys        (k, n)     int64: key[i] - key[i - 1]
    planes      (8, m, n)  bytes of m columns in the order of keys, the heaviest byte first
    predictors  (m,)       bytes; logs of older versions have none: 0 for every column
    constants   (2,)       float64: what predictors need beside the columns
    bodies      (b, 8)     float64: shapes and places of the bodies, where contacts of spheres are
                           expected by them (`sphere_contacts`); empty where they are not

The inverse needs no bit more: keys give the order back. A column that follows from others bit for
bit (`Column.derived`) is not stored where they are; the channel's metadata has its rule.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.engine.effects import EFFECTS, Derived
from lavendersim.trace import predictors
from lavendersim.trace.layout import bytes_field
from lavendersim.trace.message_form import columns_of_words, words_of
from lavendersim.trace.predictors import ALONE, SPECIAL, SPHERES, Constants
from lavendersim.trace.schema import OF_THE_MESSAGE
from lavendersim.trace.scratch import scratch
from lavendersim.trace.sphere_contacts import COLUMNS as OF_SPHERES
from lavendersim.trace.sphere_contacts import (
    FIELDS,
    POSITION,
    Expected,
    Floats,
    Starts,
    expected_contacts,
    place_contacts,
)

DERIVED: dict[str, Derived] = {
    column.name: column.derived
    for effect in EFFECTS
    for column in effect.contact_columns
    if column.derived is not None
}
KEY: Final[tuple[str, ...]] = ("body_a", "body_b", "feature")
Integers = NDArray[np.int64]
Tables = Sequence[NDArray[Any]]  # of the same columns, at least one


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
    rows: Tables  # of all, one step after the other; in parts, as they stand in memory
    starts: Starts | None = None  # of spheres, by which their contacts are expected


def message_of(
    group: ContactGroup, form: ColumnForm, constants: Constants
) -> list[bytes | memoryview]:
    """Return the lavender.ContactColumns of some steps, in pieces."""
    packed = pack(group.rows, form.names, constants, group.starts)
    numbers = [column.astype("<i8").tobytes() for column in group[:3]]
    pieces: list[bytes | memoryview] = []
    for number, part in enumerate(numbers, 1):
        pieces += [bytes_field(number, len(part)), part]
    pieces.append(_names_and_kinds(form))
    for number, one in enumerate(packed, len(numbers) + 3):
        pieces += [bytes_field(number, len(one)), one]
    return pieces


@lru_cache(maxsize=64)
def _names_and_kinds(form: ColumnForm) -> bytes:
    """Return the fields that say which columns there are: the same in every message of a log."""
    return b"".join(
        bytes_field(number, len(text)) + text.encode()
        for number, texts in ((4, form.names), (5, form.kinds))
        for text in texts
    )


class Packed(NamedTuple):
    """The same as bytes."""

    keys: bytes | memoryview
    planes: bytes | memoryview
    predictors: bytes = b""  # none: as in older logs
    constants: bytes = bytes(16)  # float64 each
    bodies: bytes = b""  # none: no contact is expected by them


def pack(
    rows: Tables,
    names: tuple[str, ...],
    constants: Constants,
    starts: Starts | None = None,
) -> Packed:
    """Return contacts as bytes; names: of the columns that are stored, each of eight bytes.

    The planes are in memory that is used again when this thread packs again.
    """
    from lavendersim.engine.difference_kernel import (
        PART,
        gather_columns,
        pack_columns,
    )  # late: numba

    tables = [words_of(part) for part in rows]
    known_keys, columns = tuple(name for name in KEY if name in names), _numbers(names)
    count = sum(map(len, tables))

    def gather(order: NDArray[np.intp], wanted: tuple[str, ...], words: predictors.Words) -> None:
        first = 0
        for table in tables:
            gather_columns()(table, first, order, _places(wanted, rows[0].dtype), words)
            first += len(table)

    keys = np.empty((len(known_keys), count), np.int64)
    gather(np.arange(count), known_keys, keys.view(np.uint64))
    order, persists = _order(keys)
    words = scratch("words", (len(columns), count), np.uint64)
    gather(order, columns, words)
    named = dict(zip(columns, words, strict=True))
    spheres = None
    if starts is not None and {"body_a", "body_b"} <= {*names}:
        spheres = place_contacts(keys, order, starts)
        if not _is_of_spheres(spheres, named):
            spheres = None  # others have predictors of their own
    special, asked = _asked(columns, spheres is not None)
    expected = scratch("expected", (len(asked) + 1, count), np.uint64)
    for place, (name, predictor) in enumerate(asked):
        if predictor == SPHERES and spheres is not None:
            expected[place] = spheres.columns[name].view(np.uint64)
        else:
            sources = _sources(name, columns)
            predictors.expect(predictor, (words, sources, persists), constants, expected[place])
    known = np.zeros(count, bool) if spheres is None else spheres.known
    chosen = np.zeros(len(columns), np.int64)
    planes = scratch("planes", (8, len(columns), count), np.uint8)
    size = np.zeros(predictors.COUNT, np.int64)
    packed = chosen, planes, np.empty(PART, np.uint64)
    pack_columns()(words, (persists, known), special, expected, size, packed)
    bodies = b""
    used = chosen.tolist()
    if starts is not None and SPHERES in used:
        bodies = _with_positions(starts).astype("<f8").tobytes()
    differences = keys.copy()
    differences[:, 1:] -= keys[:, :-1]
    return Packed(
        differences.view(np.uint8).reshape(-1).data,
        planes.reshape(-1).data,
        bytes(used),
        np.array(constants, "<f8").tobytes(),
        bodies,
    )


def _expected_by(
    starts: Starts | None, keys: Integers, names: Sequence[str], order: NDArray[np.intp]
) -> Expected | None:
    """Return contacts of spheres as they are expected, in the order of keys."""
    if starts is None or not {"body_a", "body_b"} <= {*names}:
        return None
    starts = starts._replace(step=starts.step[order])
    return expected_contacts(keys[0, order], keys[1, order], starts)


def _is_of_spheres(spheres: Expected, columns: Mapping[str, predictors.Words]) -> bool:
    """Whether at least half of the contacts are as far apart as is expected, to the last bit."""
    if "separation" not in columns:
        return False
    exact = spheres.columns["separation"].view(np.uint64) == columns["separation"]
    return bool(2 * np.count_nonzero(exact & spheres.known) >= len(exact) > 0)


def _with_positions(starts: Starts) -> Floats:
    """Return the bodies, each with its place at the start of the first step."""
    bodies = starts.bodies.copy()
    bodies[:, POSITION] = starts.positions[0]
    return bodies


@lru_cache(maxsize=64)
def _places(columns: tuple[str, ...], row: np.dtype[Any]) -> Integers:
    """Return where columns stand in the words of rows."""
    places = columns_of_words(row)
    return np.array([places[name] for name in columns], np.int64)


@lru_cache(maxsize=64)
def _asked(
    columns: tuple[str, ...], of_spheres: bool
) -> tuple[Integers, tuple[tuple[str, int], ...]]:
    """Return the predictor that each column alone has, 0 for none; and of those that have one."""
    special = [_special(name, columns, of_spheres) for name in columns]
    asked = tuple((name, code) for name, code in zip(columns, special, strict=True) if code)
    return np.array(special, np.int64), asked


@lru_cache(maxsize=64)
def _sources(name: str, columns: tuple[str, ...]) -> Integers:
    """Return which of some columns the predictor of one needs that only this column has."""
    return np.array([columns.index(one) for one in SPECIAL[name][1]], np.int64)


def _special(name: str, columns: Sequence[str], of_spheres: bool) -> int:
    """Return the predictor that only this column has, 0 for none."""
    if of_spheres and name in OF_SPHERES:
        return SPHERES
    predictor, sources = SPECIAL.get(name, (0, ()))
    return predictor if all(source in columns for source in sources) else 0


def unpack(
    packed: Packed,
    names: tuple[str, ...],
    table: NDArray[Any],
    starts: Callable[[Floats], Starts] | None = None,
) -> None:
    """Fill the columns of a table. ValueError where the bytes are not as many as it has rows.

    starts: where the bodies of the rows are, by the table of bodies that the log has.
    """
    count = len(table)
    known, columns = [name for name in KEY if name in names], _numbers(names)
    keys = np.frombuffer(packed.keys, np.int64).reshape(len(known), count).cumsum(axis=1)
    order, persists = _order(keys)
    own = predictors.keys_of(persists)
    planes = np.frombuffer(packed.planes, np.uint8).reshape(8, len(columns), count)
    heaviest_last = np.ascontiguousarray(planes[::-1].transpose(1, 2, 0))
    stored = dict(zip(columns, heaviest_last.view(np.uint64)[:, :, 0], strict=True))
    chosen = _chosen(packed, columns)
    constants = Constants(*np.frombuffer(packed.constants, "<f8").tolist())
    spheres = None
    if SPHERES in chosen.values() and starts is not None:
        bodies = np.frombuffer(packed.bodies, "<f8").reshape(-1, FIELDS)
        spheres = _expected_by(starts(bodies), keys, names, order)
    words: dict[str, predictors.Words] = {}
    for name, predictor in sorted(chosen.items(), key=_when):
        if predictor != SPHERES:
            expected = None
            if predictor not in ALONE:
                expected = predictors.expected(predictor, words, persists, constants)
            words[name] = predictors.numbers(predictor, stored[name], expected, own)
            continue
        if spheres is None:
            raise ValueError(f"column {name} has predictor {predictor} without bodies")
        expected = spheres.columns[name].view(np.uint64)
        of_spheres = predictors.numbers(SPHERES, stored[name], expected, own)
        others = predictors.numbers(predictors.LINEAR, stored[name], None, own)
        words[name] = np.where(spheres.known, of_spheres, others)
    for name, key in zip(known, keys, strict=True):
        table[name] = key
    for name, column in words.items():
        table[name][order] = column.view(table.dtype[name])


def _when(column: tuple[str, int]) -> tuple[bool, int]:
    """Return what orders columns so that those come first of which others are expected."""
    _, predictor = column
    return predictor not in (*ALONE, SPHERES), predictor


def _chosen(packed: Packed, columns: Sequence[str]) -> dict[str, int]:
    """Return the predictor of each column. ValueError for one that this version does not know."""
    chosen = dict(zip(columns, packed.predictors or bytes(len(columns)), strict=True))
    for name, predictor in chosen.items():
        if predictor not in (*ALONE, _special(name, columns, bool(packed.bodies))):
            raise ValueError(f"column {name} has predictor {predictor}, none of this version")
    return chosen


@lru_cache(maxsize=64)
def _numbers(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(name for name in names if name not in KEY)


def _order(keys: Integers) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the rows in the order of keys, by step in each, and which follow one of their key."""
    count = keys.shape[1]
    if not (len(keys) and count):
        return np.arange(count), np.zeros(count, bool)
    persists = np.zeros(count, bool)
    one = _as_one(keys)
    if one is None:
        order = np.lexsort(keys[::-1])
        ordered = keys[:, order]
        persists[1:] = (ordered[:, 1:] == ordered[:, :-1]).all(axis=0)
    else:
        order = one.argsort(kind="stable")
        ordered = one[order]
        persists[1:] = ordered[1:] == ordered[:-1]
    return order, persists


def _as_one(keys: Integers) -> Integers | None:
    """Return keys (k, n) as one number each (n,), in the same order; None where none is as large.

    Sorting one number takes half the time of sorting three.
    """
    lows, highs = keys.min(axis=1).tolist(), keys.max(axis=1).tolist()
    spans = [high - low + 1 for low, high in zip(lows, highs, strict=True)]
    if math.prod(spans) >= 2**63:
        return None
    one: Integers = keys[0] - lows[0]
    for key, low, span in zip(keys[1:], lows[1:], spans[1:], strict=True):
        one *= span
        one += key
        one -= low
    return one
