"""The records of a file that may be damaged, one after the other, and on behind what is none.

    magic Header Attachment.. Metadata.. (Chunk MessageIndex..).. Metadata DataEnd  summary  Footer

A record stands where its bytes say so more than once: an attachment and a metadata record by their
CRCs, a chunk by two lengths and the name of its compression, a message index by two lengths and its
channel. Where none stands, the next one is searched for. No more than one record is in memory.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from typing import Any, BinaryIO, Final, NamedTuple

from mcap.exceptions import McapError
from mcap.opcode import Opcode

from lavendersim.trace.index import PARSERS, parse, parse_metadata
from lavendersim.trace.layout import CHANNELS, RECORD_HEADER
from lavendersim.trace.whole import BLOCK, MAGIC

NOTHING: Final = 0  # in place of an opcode: no whole record stands there
SUMMARY: Final = frozenset(
    (
        *(Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS, Opcode.CHUNK_INDEX),
        *(Opcode.ATTACHMENT_INDEX, Opcode.METADATA_INDEX, Opcode.SUMMARY_OFFSET, Opcode.FOOTER),
    )
)
# What a length that damage made could claim; a chunk's and a message index's stand there twice.
MOST_BYTES: Final = 64 * 1024 * 1024
MOST_NAME: Final = 1024
_HEAD: Final = struct.Struct("<BQ")
# times, size and CRC of what is compressed; name of the compression; length of what follows
_CHUNK: Final = struct.Struct("<QQQII4sQ")
_INDEX: Final = struct.Struct("<HI")
# where a record of this version can begin: an opcode, and a length below 4 GiB
_BEGIN: Final = re.compile(rb"(?=[\x01-\x0f].{4}\0{4})", re.DOTALL)
_REFUSALS: Final = (McapError, ValueError, KeyError, EOFError, struct.error, OverflowError)


class Found(NamedTuple):
    """A stretch of the file: one record, or bytes that are none."""

    start: int
    end: int
    opcode: int
    record: Any = None  # none of a message index; a chunk is not opened


def walk(stream: BinaryIO) -> Iterator[Found]:
    """Yield what stands in a file, gap by record by gap, up to its summary or its end."""
    size = stream.seek(0, 2)
    position = min(len(MAGIC), size)
    if _read(stream, 0, position) != MAGIC:
        yield Found(0, position, NOTHING)
    while position < size:
        found = _record_at(stream, position, size)
        if found is None:
            found = Found(position, _next_record(stream, position + 1, size), NOTHING)
        yield found
        if found.opcode == Opcode.DATA_END or found.opcode in SUMMARY:
            return
        position = found.end


def _read(stream: BinaryIO, start: int, length: int) -> bytes:
    stream.seek(start)
    return stream.read(length)


def _next_record(stream: BinaryIO, position: int, size: int) -> int:
    """Return where the next record stands, from `position` on; the end of the file if none does."""
    while position < size:
        block = _read(stream, position, BLOCK)
        for match in _BEGIN.finditer(block):
            if _record_at(stream, position + match.start(), size) is not None:
                return position + match.start()
        # a beginning may lie across the end of the block
        position += max(len(block) - RECORD_HEADER + 1, 1)
    return size


def _record_at(stream: BinaryIO, start: int, size: int) -> Found | None:
    """Return the record that stands at `start`; None where none does."""
    head = _read(stream, start, RECORD_HEADER + _CHUNK.size)
    if len(head) < RECORD_HEADER:
        return None
    opcode, length = _HEAD.unpack_from(head)
    end = start + RECORD_HEADER + length
    if end > size or not _is_plausible(opcode, length, head[RECORD_HEADER:]):
        return None
    record = None
    try:
        if opcode != Opcode.MESSAGE_INDEX:
            data = _read(stream, start, end - start)
            is_metadata = opcode == Opcode.METADATA
            record = parse_metadata(data) if is_metadata else parse(data, PARSERS[opcode])
    except _REFUSALS:
        return None
    return Found(start, end, opcode, record)


def _is_plausible(opcode: int, length: int, body: bytes) -> bool:
    """Whether the first bytes of a record fit its opcode and length."""
    if opcode == Opcode.CHUNK:
        if len(body) < _CHUNK.size or length < _CHUNK.size:
            return False
        *_, width, compression, records = _CHUNK.unpack_from(body)
        return bool((width, compression, records) == (4, b"zstd", length - _CHUNK.size))
    if opcode == Opcode.MESSAGE_INDEX:
        if len(body) < _INDEX.size or length < _INDEX.size:
            return False
        channel, entries = _INDEX.unpack_from(body)
        return channel in CHANNELS.values() and entries == length - _INDEX.size
    if opcode in (Opcode.ATTACHMENT, Opcode.METADATA):
        name = body[16:20] if opcode == Opcode.ATTACHMENT else body[:4]
        return length <= MOST_BYTES and int.from_bytes(name, "little") <= MOST_NAME
    return length <= MOST_BYTES and opcode in PARSERS
