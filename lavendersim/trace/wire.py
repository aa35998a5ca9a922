"""Fixed protobuf layouts whose slots are filled for many messages at once.

A message whose layout does not change from step to step is one template: constant bytes (tags,
lengths, names) with holes (slots) in it. Writing n messages is tiling the template n times and
filling the holes (`message_form`); reading is checking the constant bytes and taking the holes.

    template   05 len.. ch.. [seq.] [log_time] [publish_time] 09 [8 bytes] 11 [8 bytes] ...
                                                              tag  slot    tag  slot

A slot is a run of bytes seen as numpy's void type, so that one assignment moves n of them by
memcpy, at any alignment. No Python runs per message.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Rows = NDArray[Any]

VARINT_WIDTH = 5  # bytes of a padded varint: 35 bits, enough for 1,000 years of seconds
NANOSECONDS = 1_000_000_000
# one entry of a MessageIndex
INDEX_ENTRY = np.dtype([("time", "<u8"), ("offset", "<u8")])

# protobuf wire types
VARINT, FIXED64, LENGTH = 0, 1, 2


def varint(value: int) -> bytes:
    """Return `value` as the shortest protobuf varint."""
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


@lru_cache(maxsize=256)
def tag(number: int, wire_type: int) -> bytes:
    """Return the tag bytes of field `number`."""
    return varint(number << 3 | wire_type)


def padded_varints(values: Rows) -> Bytes:
    """Return (n, 5) bytes: each value as a varint of fixed width.

    A varint padded with continuation bits is legal protobuf and keeps every offset constant.
    """
    shifts = np.arange(VARINT_WIDTH, dtype=np.uint64) * np.uint64(7)
    out: Bytes = ((values.astype(np.uint64)[:, None] >> shifts) & np.uint64(0x7F)).astype(np.uint8)
    out[:, :-1] |= 0x80
    return out


def _windows(data: Bytes, size: int) -> Rows:
    """Return a view of `data` whose item i is the `size` bytes that start at byte i."""
    return np.ndarray((max(len(data) - size + 1, 0),), f"V{size}", data, 0, (1,))


def gather(data: Bytes, offsets: Rows, size: int) -> Bytes:
    """Return (n, size) bytes: those that start at each offset. IndexError outside `data`."""
    if not len(offsets):
        return np.empty((0, size), np.uint8)
    rows: Bytes = _windows(data, size)[offsets].view(np.uint8).reshape(-1, size)
    return rows


def rows_behind(starts: Rows, counts: Rows, size: int) -> Rows:
    """Return the byte offset of every row of `size` bytes; rows of one start follow each other."""
    before = np.cumsum(counts) - counts
    offsets: Rows = np.repeat(starts - before * size, counts) + np.arange(counts.sum()) * size
    return offsets


class Template:
    """Constant bytes with named slots; a name may stand for many slots of one size."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._slots: dict[str, list[int]] = {}
        self._sizes: dict[str, int] = {}

    def __len__(self) -> int:
        return len(self._bytes)

    @property
    def data(self) -> bytes:
        """Return its bytes, 0 in the slots."""
        return bytes(self._bytes)

    @property
    def slots(self) -> dict[str, tuple[int, list[int]]]:
        """Return by name how wide slots are [B], and where they begin."""
        return {name: (self._sizes[name], offsets) for name, offsets in self._slots.items()}

    def constant(self, data: bytes) -> Template:
        """Append bytes that are the same in every message."""
        self._bytes += data
        return self

    def slot(self, name: str, size: int) -> Template:
        """Append a hole of `size` bytes."""
        if self._sizes.setdefault(name, size) != size:
            raise ValueError(f"slot {name!r} has two sizes")
        self._slots.setdefault(name, []).append(len(self._bytes))
        self._bytes += bytes(size)
        return self

    def embed(self, inner: Template) -> Template:
        """Append another template as it is."""
        start = len(self._bytes)
        self._bytes += inner._bytes
        for name, offsets in inner._slots.items():
            self._sizes.setdefault(name, inner._sizes[name])
            self._slots.setdefault(name, []).extend(start + offset for offset in offsets)
        return self

    def message(self, number: int, inner: Template) -> Template:
        """Append field `number` holding `inner` as a protobuf sub-message."""
        return self.constant(tag(number, LENGTH) + varint(len(inner))).embed(inner)

    def string(self, number: int, text: str) -> Template:
        """Append field `number` holding a constant string."""
        data = text.encode()
        return self.constant(tag(number, LENGTH) + varint(len(data)) + data)

    def word(self, number: int, name: str) -> Template:
        """Append field `number` holding eight bytes: double, fixed64 or sfixed64."""
        return self.constant(tag(number, FIXED64)).slot(name, 8)

    def timestamp(self, number: int) -> Template:
        """Append field `number` holding a google.protobuf.Timestamp of fixed width."""
        inner = Template().constant(tag(1, VARINT)).slot("seconds", VARINT_WIDTH)
        inner.constant(tag(2, VARINT)).slot("nanos", VARINT_WIDTH)
        return self.message(number, inner)

    def rows(self, count: int) -> Bytes:
        """Return (count, size) bytes: the template, its slots still empty."""
        return np.tile(np.frombuffer(bytes(self._bytes), np.uint8), (count, 1))

    def take(self, rows: Bytes, name: str) -> Rows:
        """Return (n, k) void items: what stands in the slots of that name."""
        view, offsets = self._view(rows, name)
        taken: Rows = view[:, offsets]
        return taken

    def matches(self, rows: Bytes) -> bool:
        """Tell whether every constant byte is as the template says."""
        mask = np.full(len(self), 0xFF, np.uint8)
        for name, offsets in self._slots.items():
            for offset in offsets:
                mask[offset : offset + self._sizes[name]] = 0
        return bool(np.all((rows & mask) == np.frombuffer(bytes(self._bytes), np.uint8)))

    def _view(self, rows: Bytes, name: str) -> tuple[Rows, list[int]]:
        """Return rows as overlapping windows of the slot's size, and where the slots are."""
        count, size = rows.shape
        width = self._sizes[name]
        shape = (count, size - width + 1)
        return np.ndarray(shape, f"V{width}", rows, 0, (size, 1)), self._slots[name]
