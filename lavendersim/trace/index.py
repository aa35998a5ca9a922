"""What stands where in a finished log, from its summary; every record is checked.

Nothing is trusted: a record must be, byte for byte, what writing the parsed record again gives
(which includes the CRC of an attachment), a chunk must match its index entry and its CRC, and the
messages of a chunk must fill it without a gap.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np
import zstandard
from google.protobuf.message import DecodeError
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from zlib_ng.zlib_ng import crc32

from lavendersim.errors import TraceError
from lavendersim.trace.container import (
    CRC_KEY,
    FileIndex,
    Messages,
    index_of,
    message_index,
    metadata_crc,
)
from lavendersim.trace.layout import RECORD_HEADER
from lavendersim.trace.limits import check_chunk, check_chunks
from lavendersim.trace.record_bytes import to_bytes
from lavendersim.trace.whole import LogDigest, read_end
from lavendersim.trace.wire import INDEX_ENTRY, Bytes, gather

PARSERS: dict[int, Any] = {
    Opcode.HEADER: Header,
    Opcode.FOOTER: Footer,
    Opcode.SCHEMA: Schema,
    Opcode.CHANNEL: Channel,
    Opcode.CHUNK: Chunk,
    Opcode.CHUNK_INDEX: ChunkIndex,
    Opcode.ATTACHMENT: Attachment,
    Opcode.ATTACHMENT_INDEX: AttachmentIndex,
    Opcode.METADATA: Metadata,
    Opcode.METADATA_INDEX: MetadataIndex,
    Opcode.STATISTICS: Statistics,
    Opcode.SUMMARY_OFFSET: SummaryOffset,
    Opcode.DATA_END: DataEnd,
}

MOST_DESCRIPTIONS = 1000  # schemas and channels of a chunk; a log has about ten
_HEAD = struct.Struct("<BQ")
MESSAGE = np.dtype([("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4")])
_CLOCKED = np.dtype([*MESSAGE.descr, ("log_time", "<u8"), ("publish_time", "<u8")])


@contextmanager
def damage(path: Path, what: str) -> Iterator[None]:
    """Turn whatever reading broken bytes can raise into a TraceError that names the file."""
    try:
        yield
    except (
        *(McapError, DecodeError, zstandard.ZstdError, struct.error, EOFError),
        *(ValueError, KeyError, IndexError, TypeError, AttributeError, MemoryError),
        *(ArithmeticError, RecursionError),
    ) as error:
        raise TraceError(
            f"{path}: {what} is damaged ({str(error) or type(error).__name__})"
        ) from error


def parse(data: bytes, expected: type) -> Any:
    """Return the record that `data` is. ValueError unless it is one, of that type, unspoilt."""
    opcode, length = _HEAD.unpack_from(data)
    if PARSERS.get(opcode) is not expected or length != len(data) - RECORD_HEADER:
        raise ValueError(f"no {expected.__name__} record where there should be one")
    record = PARSERS[opcode].read(ReadDataStream(BytesIO(data[RECORD_HEADER:])))
    if to_bytes(record) != data:
        raise ValueError(f"the {expected.__name__} record fails its check")
    return record


def parse_metadata(data: bytes) -> Metadata:
    """Return a metadata record. ValueError when its own checksum says it was changed."""
    record: Metadata = parse(data, Metadata)
    if record.metadata.get(CRC_KEY) != metadata_crc(record.name, record.metadata):
        raise ValueError(f"metadata {record.name!r} fails its check")
    return record


class Span(NamedTuple):
    """Where a record stands in some bytes."""

    opcode: int
    start: int  # [B]
    end: int  # [B]


def spans(data: bytes, start: int = 0) -> Iterator[Span]:
    """Yield where each record stands; stops where the next one is not whole."""
    while start + RECORD_HEADER <= len(data):
        opcode, length = _HEAD.unpack_from(data, start)
        end = start + RECORD_HEADER + length
        if end > len(data):
            return
        yield Span(opcode, start, end)
        start = end


def records_of(payload: bytes) -> Iterator[Span]:
    """Yield the records of a chunk as `spans` does. ValueError for others than it can have.

    Of zeros, which cost nothing when compressed, every nine bytes would be a record.
    """
    before = 0
    for span in spans(payload):
        if span.opcode != Opcode.MESSAGE:
            before += 1
            if span.opcode not in (Opcode.SCHEMA, Opcode.CHANNEL) or before > MOST_DESCRIPTIONS:
                raise ValueError("a chunk has records that are none of a chunk")
        yield span


def read_summary(path: Path, expected: LogDigest | None = None) -> FileIndex:
    """Return the index of a finished file. TraceError when it is unfinished, damaged or another."""
    with damage(path, "the summary"), path.open("rb") as stream:
        summary = read_end(path, stream, expected).summary
        index = FileIndex()
        for opcode, start, end in spans(summary):
            note(index, parse(summary[start:end], PARSERS[opcode]))
        check_chunks(index.chunks, stream.seek(0, 2))
        return index


def note(index: FileIndex, record: Any) -> None:
    """Enter a summary record into the index."""
    if isinstance(record, Schema):
        index.schemas[record.id] = record
    elif isinstance(record, Channel):
        index.channels[record.id] = record
    elif isinstance(record, ChunkIndex):
        index.chunks.append(record)
    elif isinstance(record, AttachmentIndex):
        index.attachments.append(record)
    elif isinstance(record, MetadataIndex):
        index.metadata.append(record)
    elif isinstance(record, Statistics):
        index.counts = record.channel_message_counts


def read_at(stream: BinaryIO, offset: int, length: int) -> bytes:
    """Return bytes of a file. ValueError when it is shorter."""
    if length < 0 or offset + length > stream.seek(0, 2):
        raise ValueError("the file is too short")
    stream.seek(offset)
    return stream.read(length)


class ChunkContent(NamedTuple):
    """A checked chunk: its bytes, the records before its messages, and the messages by channel."""

    data: Bytes
    prologue: bytes
    messages: dict[int, Any]  # channel -> INDEX_ENTRY rows


def read_chunk(stream: BinaryIO, entry: ChunkIndex) -> ChunkContent:
    """Return the chunk an index entry points to. ValueError unless every check holds."""
    record = read_at(stream, entry.chunk_start_offset, entry.chunk_length)
    at = entry.chunk_start_offset + entry.chunk_length
    indexes = read_at(stream, at, entry.message_index_length)
    chunk: Chunk = parse(record, Chunk)
    found = index_of(chunk, entry.chunk_start_offset, entry.chunk_length)
    messages = message_indexes(indexes)
    position = at
    for group in messages:
        found.message_index_offsets[group.channel] = position
        position += len(message_index(group))
    found.message_index_length = position - at
    if found != entry:
        raise ValueError("a chunk contradicts its index")
    return open_chunk(chunk, messages)


def message_indexes(data: bytes) -> list[Messages]:
    """Return the MessageIndex records that `data` consists of."""
    found = []
    end = 0
    for opcode, start, end in spans(data):
        channel, length = struct.unpack_from("<HI", data, start + RECORD_HEADER)
        entries = np.frombuffer(data[start + RECORD_HEADER + 6 : end], INDEX_ENTRY)
        if opcode != Opcode.MESSAGE_INDEX or length != entries.nbytes:
            raise ValueError("a message index fails its check")
        found.append(Messages(channel, entries))
    if end != len(data):
        raise ValueError("a message index is cut")
    return found


def open_chunk(chunk: Chunk, messages: Sequence[Messages]) -> ChunkContent:
    """Return the content of a chunk. ValueError unless CRC and message indexes hold."""
    if chunk.compression != "zstd":
        raise ValueError(f"chunk compression {chunk.compression!r} is not lavender's")
    check_chunk(chunk)
    payload = zstandard.ZstdDecompressor().decompress(chunk.data, chunk.uncompressed_size)
    if crc32(payload) != chunk.uncompressed_crc or len(payload) != chunk.uncompressed_size:
        raise ValueError("a chunk fails its CRC")
    first = 0
    for opcode, first, end in records_of(payload):
        if opcode == Opcode.MESSAGE:
            break
        first = end
    data = np.frombuffer(payload, np.uint8)
    _check_tiling(data, first, messages)
    groups = {group.channel: group.entries for group in messages}
    return ChunkContent(data, payload[:first], groups)


def _check_tiling(data: Bytes, first: int, messages: Sequence[Messages]) -> None:
    """Raise ValueError unless the messages fill `data` from `first` on, without gap or overlap."""
    entries = np.concatenate([np.empty(0, INDEX_ENTRY), *(group.entries for group in messages)])
    channels = np.repeat([group.channel for group in messages], [len(g.entries) for g in messages])
    order = np.argsort(entries["offset"], kind="stable")
    entries, channels = entries[order], channels[order]
    if np.any(entries["offset"] >= np.uint64(len(data))):
        raise ValueError("a message index points outside its chunk")
    offsets = entries["offset"].astype(np.int64)
    heads = gather(data, offsets, _CLOCKED.itemsize).view(_CLOCKED)[:, 0]
    ends = offsets + RECORD_HEADER + heads["length"].astype(np.int64)
    tiled = np.array_equal(np.append(offsets, len(data)), np.insert(ends, 0, first))
    same = np.array_equal(heads["channel"], channels)
    clocked = np.array_equal(heads["log_time"], entries["time"])
    if not (tiled and same and clocked and np.all(heads["opcode"] == Opcode.MESSAGE)):
        raise ValueError("a message index contradicts its chunk")
