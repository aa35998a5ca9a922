"""Records of MCAP as bytes: what `mcap.records` writes themselves into, a list of pieces.

Of mcap's own `RecordBuilder` this has the methods that records call. It packs with formats that are
compiled once, seeks nowhere, and does not copy what is large: half of the time of a short log. Of
records that every log has many of, all numbers are packed at once (`_AT_ONCE`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from struct import Struct
from typing import Any, Final

from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    McapRecord,
    MetadataIndex,
    Statistics,
    SummaryOffset,
)
from zlib_ng.zlib_ng import crc32

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


_INDEXED: Final = Struct("<HQ").pack  # channel, offset of its index
_CHUNK, _CHUNK_INDEX = (Struct(form).pack for form in ("<BQQQQI", "<BQQQQQI"))
_ATTACHMENT, _METADATA = (Struct(form).pack for form in ("<BQQQQQQ", "<BQQQ"))
_TWO_SIZES, _OFFSET = (Struct(form).pack for form in ("<QQ", "<BQBQQ"))
_DATA_END, _FOOTER = (Struct(form).pack for form in ("<BQI", "<BQQQI"))
_STATISTICS: Final = Struct("<BQQHIIIIQQI").pack


def _text(value: str) -> bytes:
    data = value.encode()
    return _FOUR(len(data)) + data


def _chunk(one: Chunk) -> list[bytes]:
    compression, size = _text(one.compression), len(one.data)
    numbers = one.message_start_time, one.message_end_time, one.uncompressed_size
    length = 36 + len(compression) + size
    head = _CHUNK(Opcode.CHUNK, length, *numbers, one.uncompressed_crc)
    return [head + compression + _EIGHT(size), one.data]


def _chunk_index(one: ChunkIndex) -> list[bytes]:
    compression = _text(one.compression)
    offsets = b"".join(_INDEXED(*pair) for pair in one.message_index_offsets.items())
    times = one.message_start_time, one.message_end_time
    place = one.chunk_start_offset, one.chunk_length
    length = 60 + len(offsets) + len(compression)
    head = _CHUNK_INDEX(Opcode.CHUNK_INDEX, length, *times, *place, len(offsets))
    sizes = _TWO_SIZES(one.compressed_size, one.uncompressed_size)
    return [head + offsets + _EIGHT(one.message_index_length) + compression + sizes]


def _attachment(one: Attachment) -> list[bytes]:
    texts, size = _text(one.name) + _text(one.media_type), len(one.data)
    content = _TWO_SIZES(one.log_time, one.create_time) + texts + _EIGHT(size)
    crc = crc32(one.data, crc32(content))
    return [_HEAD(Opcode.ATTACHMENT, len(content) + size + 4) + content, one.data, _FOUR(crc)]


def _attachment_index(one: AttachmentIndex) -> list[bytes]:
    texts = _text(one.name) + _text(one.media_type)
    numbers = one.offset, one.length, one.log_time, one.create_time, one.data_size
    return [_ATTACHMENT(Opcode.ATTACHMENT_INDEX, 40 + len(texts), *numbers) + texts]


def _metadata_index(one: MetadataIndex) -> list[bytes]:
    name = _text(one.name)
    return [_METADATA(Opcode.METADATA_INDEX, 16 + len(name), one.offset, one.length) + name]


def _summary_offset(one: SummaryOffset) -> list[bytes]:
    numbers = one.group_opcode, one.group_start, one.group_length
    return [_OFFSET(Opcode.SUMMARY_OFFSET, 17, *numbers)]


def _statistics(one: Statistics) -> list[bytes]:
    counts = b"".join(_INDEXED(*pair) for pair in one.channel_message_counts.items())
    parts = one.attachment_count, one.metadata_count, one.chunk_count
    head = _STATISTICS(
        *(Opcode.STATISTICS, 46 + len(counts)),
        *(one.message_count, one.schema_count, one.channel_count, *parts),
        *(one.message_start_time, one.message_end_time, len(counts)),
    )
    return [head + counts]


def _data_end(one: DataEnd) -> list[bytes]:
    return [_DATA_END(Opcode.DATA_END, 4, one.data_section_crc)]


def _footer(one: Footer) -> list[bytes]:
    return [
        _FOOTER(Opcode.FOOTER, 20, one.summary_start, one.summary_offset_start, one.summary_crc)
    ]


_AT_ONCE: Final[Mapping[type[McapRecord], Callable[[Any], list[bytes]]]] = {
    Chunk: _chunk,
    ChunkIndex: _chunk_index,
    Attachment: _attachment,
    AttachmentIndex: _attachment_index,
    MetadataIndex: _metadata_index,
    SummaryOffset: _summary_offset,
    Statistics: _statistics,
    DataEnd: _data_end,
    Footer: _footer,
}


def pieces_of(*records: McapRecord) -> list[bytes]:
    """Return records as bytes in pieces; of a chunk the last is its data."""
    pieces: list[bytes] = []
    for record in records:
        at_once = _AT_ONCE.get(type(record))
        if at_once is None:
            builder: Any = _Pieces()
            record.write(builder)
            pieces += builder.pieces
        else:
            pieces += at_once(record)
    return pieces


def to_bytes(*records: McapRecord) -> bytes:
    """Return records as bytes."""
    return b"".join(pieces_of(*records))
