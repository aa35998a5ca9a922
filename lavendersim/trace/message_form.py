"""Messages of one layout, laid out in bytes by a kernel: which slot takes which number.

Numbers come as two tables of eight-byte words, bit for bit: `words`, the rows of a column table as
they stand in memory, and `heads`, what a step has beside them. Slots of eight bytes take a column
of either, others the low bytes of a head, or a varint of their width.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.trace.wire import NANOSECONDS, VARINT_WIDTH, Bytes, Rows, Template

Words = NDArray[np.uint64]
WORD: Final = 8  # [B]
STEP, TIME, SECONDS, NANOS = range(4)  # columns of heads: the step's number, and its time [ns]
MORE: Final = 4  # where what a message has of its own begins
OF_STEP: Final = {"sequence": [STEP], "clock": [TIME], "seconds": [SECONDS], "nanos": [NANOS]}


class MessageForm(NamedTuple):
    """A layout and where its numbers come from; see `engine.message_kernel`."""

    template: Bytes
    text: Words  # the template, as many words of it as are whole
    slots: Words
    head_slots: Words
    odd_slots: Words

    def __len__(self) -> int:
        """Return the bytes of one."""
        return len(self.template)

    def fill(self, data: Bytes, starts: Rows, words: Words, heads: Words) -> None:
        """Write one message per start into the bytes of a chunk, which has room for them."""
        if len(starts):
            from lavendersim.engine.message_kernel import fill_messages  # late: numba

            fill_messages()(
                data,
                np.ascontiguousarray(starts, np.int64).view(np.uint64),
                (self.template, self.text, self.slots, self.head_slots, self.odd_slots),
                words,
                heads,
            )


def message_form(
    template: Template, words: Mapping[str, Sequence[int]], heads: Mapping[str, Sequence[int]]
) -> MessageForm:
    """Return the form of messages of a template; words, heads: columns of these by names of slots.

    A name that stands for several slots has a column for each, or one for all.
    """
    slots: list[tuple[int, int]] = []
    head_slots: list[tuple[int, int]] = []
    odd_slots: list[tuple[int, int, int, int]] = []
    for name, (size, offsets) in template.slots.items():
        columns = words.get(name) or {**OF_STEP, **heads}[name]
        if len(columns) == 1:
            columns = [*columns] * len(offsets)
        for offset, column in zip(offsets, columns, strict=True):
            if name in words:
                slots.append((offset, column))
            elif size == WORD:
                head_slots.append((offset, column))
            else:
                odd_slots.append((offset, column, size, size == VARINT_WIDTH))
    data = np.frombuffer(template.data, np.uint8).copy()
    text = np.frombuffer(template.data, "<u8", len(data) // WORD).astype(np.uint64)
    return MessageForm(data, text, _table(slots, 2), _table(head_slots, 2), _table(odd_slots, 4))


def _table(rows: Sequence[Sequence[int]], width: int) -> Words:
    return np.array(rows, np.uint64).reshape(-1, width)


@lru_cache(maxsize=64)
def columns_of_words(row: np.dtype[Any]) -> Mapping[str, int]:
    """Return the column of each field in the words of rows (`words_of`)."""
    if not _is_of_words(row):
        return {name: index for index, name in enumerate(row.names or ())}
    return {name: int(place[1]) // WORD for name, place in (row.fields or {}).items()}


def words_of(rows: Rows) -> Words:
    """Return rows of eight-byte numbers as words (n, k): as they stand in memory, if they can."""
    names = rows.dtype.names or ()
    if not _is_of_words(rows.dtype):
        words = [np.ascontiguousarray(rows[name]).view(np.uint64) for name in names]
        return np.stack(words, axis=1) if words else np.zeros((len(rows), 0), np.uint64)
    return np.ascontiguousarray(rows).view(np.uint64).reshape(len(rows), rows.itemsize // WORD)


@lru_cache(maxsize=64)
def _is_of_words(row: np.dtype[Any]) -> bool:
    places = (row.fields or {}).values()
    return row.itemsize % WORD == 0 and all(place[1] % WORD == 0 for place in places)


def heads_of(step: Rows, *more: Rows) -> Words:
    """Return number and time of steps, and more integers or floats of each, as words."""
    heads = np.empty((len(step), MORE + len(more)), np.uint64)
    heads[:, STEP] = step["step"]
    heads[:, TIME] = step["time_ns"]
    np.divmod(heads[:, TIME], NANOSECONDS, heads[:, SECONDS], heads[:, NANOS])
    for column, numbers in enumerate(more, MORE):
        heads[:, column] = numbers.view(np.uint64)
    return heads
