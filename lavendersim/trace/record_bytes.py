"""Records of MCAP as bytes: what `mcap.records` writes themselves into, a list of pieces.

Of mcap's own `RecordBuilder` this has the methods that records call. It packs with formats that are
compiled once, seeks nowhere, and does not copy what is large: half of the time of a short log.
"""

from __future__ import annotations

from struct import Struct
from typing import Any, Final

from mcap.records import McapRecord

_HEAD: Final = Struct("<BQ").pack  # opcode, length of what follows
_ONE, _TWO, _FOUR, _EIGHT = (Struct(form).pack for form in ("<B", "<H", "<I", "<Q"))


class _Pieces:
    """Takes the fields of records one after the other."""

    def __init__(self) -> None:
        self.pieces: list[Any] = []
        self._first = 0  # piece of the open record: its head
        self._opcode = 0

    def start_record(self, opcode: int) -> None:
        self._first, self._opcode = len(self.pieces), opcode
        self.pieces.append(b"")

    def finish_record(self) -> None:
        length = sum(map(len, self.pieces[self._first + 1 :]))
        self.pieces[self._first] = _HEAD(self._opcode, length)

    def write(self, data: bytes | memoryview) -> None:
        self.pieces.append(data)

    def write1(self, value: int) -> None:
        self.pieces.append(_ONE(value))

    def write2(self, value: int) -> None:
        self.pieces.append(_TWO(value))

    def write4(self, value: int) -> None:
        self.pieces.append(_FOUR(value))

    def write8(self, value: int) -> None:
        self.pieces.append(_EIGHT(value))

    def write_prefixed_string(self, value: str) -> None:
        data = value.encode()
        self.pieces += (_FOUR(len(data)), data)


def pieces_of(*records: McapRecord) -> list[bytes]:
    """Return records as bytes in pieces; of a chunk the last is its data."""
    builder: Any = _Pieces()
    for record in records:
        record.write(builder)
    pieces: list[bytes] = builder.pieces
    return pieces


def to_bytes(*records: McapRecord) -> bytes:
    """Return records as bytes."""
    return b"".join(pieces_of(*records))
