"""Where fields of records lie that each plan lays out anew: named by parts, given by whole kernels.

    part            reads the field at  contact + @".place.contact.nx"
    whole kernel    @".place.contact.nx" = 24, of the plan that it is compiled for

Effects add fields to the records of bodies, velocities, pairs, contacts, their cache, links and
drives, so the same field lies elsewhere in another plan. With its place as a number in its code a
part would be another one in each; with a name it is compiled once, and LLVM puts the number there
when the whole kernel, or a separate part, is optimised. Like `part_compiler` this leans on what
numba keeps to itself.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any, Final

from llvmlite.ir import Constant, GlobalVariable, IntType
from numba.core import types

from .light_values import at_entry, pointing_to
from .records import ANGULAR_VELOCITY, BODY, CONTACT, DRIVE, LINK, MOTION, PAIR, VELOCITY, Field

PREFIX: Final = ".place."
ROW: Final = "row"  # instead of a field: from one row to the next; no field has that name
BYTE, WORD = IntType(8), IntType(64)
FIELDS = types.float64, types.int64, types.uint64  # that records have
# By the fields that each begins with.
COMPOSED: Final[dict[str, list[Field]]] = {
    "body": BODY,
    "velocity": VELOCITY,
    "pair": PAIR,
    "contact": CONTACT,
    "cache": [("key", "i8"), ("px", "f8")],
    "link": LINK,
    "drive": DRIVE,
}
_NAMES = {name: tuple(field for field, _ in fields) for name, fields in COMPOSED.items()}
# Records of velocities, too, but the same in all plans: what packed contacts keep of one, and what
# a body did within a step.
_ALIKE = {tuple(name for name, _ in fields) for fields in ([*VELOCITY, *ANGULAR_VELOCITY], MOTION)}


@cache
def composed_name(kind: Any) -> str:
    """Return which of the records that plans compose a type is; "" for all others."""
    if not isinstance(kind, types.Record) or not kind.aligned:
        return ""
    names = tuple(sorted(kind.fields, key=kind.offset))
    if names in _ALIKE or any(kind.typeof(name) not in FIELDS for name in names):
        return ""
    begins = (name for name, first in _NAMES.items() if names[: len(first)] == first)
    return next(begins, "")


def record_of(kind: Any) -> Any:
    """Return the record that a type is or has rows of; None for another type."""
    item = kind.dtype if isinstance(kind, types.Array) else kind
    return item if isinstance(item, types.Record) else None


def composed_in(kinds: Iterable[Any]) -> dict[str, Any]:
    """Return the composed records in types of arguments by their names.

    Raises RuntimeError where two have one name: a kernel would read one by the places of the other.
    """
    found: dict[str, Any] = {}
    for record in _records_in(kinds):
        name = composed_name(record)
        if name and found.setdefault(name, record) != record:
            raise RuntimeError(f"a kernel has two records of a {name}: {found[name]}, {record}")
    return found


def _records_in(kinds: Iterable[Any]) -> Iterator[Any]:
    for kind in kinds:
        if isinstance(kind, types.BaseTuple):
            inside: Any = kind
            yield from _records_in(inside)
        elif (record := record_of(kind)) is not None:
            yield record


def place(builder: Any, name: str, field: str) -> Any:
    """Return where a field of a composed record lies [byte], as the whole kernel gives it."""
    symbol = f"{PREFIX}{name}.{field}"
    known = builder.module.globals.get(symbol)
    if known is None:
        known = GlobalVariable(builder.module, WORD, symbol)
        known.global_constant = True
    return at_entry(builder, known)


def pointer(builder: Any, record: Any, name: str, field: str) -> Any:
    """Return the address of a field of a composed record, of a byte."""
    begin = pointing_to(builder, record, BYTE)
    return builder.gep(begin, (place(builder, name, field),), inbounds=True)


def row(builder: Any, data: Any, name: str, index: Any) -> Any:
    """Return a row of composed records that begin at `data`."""
    begin = pointing_to(builder, data, BYTE)
    offset = builder.mul(index, place(builder, name, ROW), flags=("nsw",))
    return pointing_to(builder, builder.gep(begin, (offset,)), data.type.pointee)


def copy(builder: Any, name: str, to: Any, of: Any) -> None:
    """Copy a composed record; both may be one and the same."""
    kind = BYTE.as_pointer()
    called = builder.module.declare_intrinsic("llvm.memcpy", [kind, kind, WORD])
    size = place(builder, name, ROW)
    ends = pointing_to(builder, to, BYTE), pointing_to(builder, of, BYTE)
    builder.call(called, [*ends, size, Constant(IntType(1), 0)])


def places_in(module: Any) -> tuple[str, ...]:
    """Return the places that a module of llvmlite names."""
    return tuple(sorted(name for name in module.globals if name.startswith(PREFIX)))


def _number(symbol: str, records: Mapping[str, Any]) -> int:
    name, field = symbol.removeprefix(PREFIX).split(".")
    record = records[name]
    return int(record.size if field == ROW else record.offset(field))


def definitions(symbols: Iterable[str], records: Mapping[str, Any]) -> str:
    """Return LLVM's text that gives these places their numbers in a plan's records."""
    lines = (f'@"{symbol}" = constant i64 {_number(symbol, records)}' for symbol in symbols)
    return "\n".join(lines)


def digest(symbols: Iterable[str], records: Mapping[str, Any]) -> str:
    """Return 16 hex digits of where these places are in a plan's records."""
    return hashlib.sha256(definitions(sorted(symbols), records).encode()).hexdigest()[:16]
