"""An MCAP file written as it comes: records, indexes and checksums around chunk payloads.

    magic Header Attachment.. Metadata.. (Chunk MessageIndex..).. Metadata DataEnd  summary  Footer

Every chunk is flushed, so a killed run leaves whole chunks behind. All bytes up to DataEnd, every
attachment, every chunk and the summary carry a CRC; metadata records, which MCAP leaves bare until
DataEnd, carry their own under the key `crc32`.
"""

from __future__ import annotations

import struct
import threading
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import zstandard
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
from numpy.typing import NDArray
from zlib_ng.zlib_ng import crc32

from lavendersim.durable_files import named
from lavendersim.trace.file_digest import FileDigest
from lavendersim.trace.record_bytes import pieces_of, to_bytes
from lavendersim.trace.whole import MAGIC, LogDigest
from lavendersim.trace.wire import INDEX_ENTRY

LIBRARY = "lavender"
CRC_KEY = "crc32"
COMPRESSION_LEVEL = 1
LONG = 64 * 1024  # [byte] of a record that is not copied to be written with others

_of_thread = threading.local()
_MESSAGE_INDEX = struct.Struct("<BQHI").pack  # opcode, length, channel, size of the entries


class Messages(NamedTuple):
    """The messages of one channel in a chunk: INDEX_ENTRY rows, in order."""

    channel: int
    entries: NDArray[Any]


@dataclass
class FileIndex:
    """What a summary says about the file; enough to read it."""

    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    chunks: list[ChunkIndex] = field(default_factory=list)
    attachments: list[AttachmentIndex] = field(default_factory=list)
    metadata: list[MetadataIndex] = field(default_factory=list)
    counts: dict[int, int] = field(default_factory=dict)

    def statistics(self) -> Statistics:
        """Return the Statistics record."""
        return Statistics(
            attachment_count=len(self.attachments),
            channel_count=len(self.channels),
            channel_message_counts=dict(sorted(self.counts.items())),
            chunk_count=len(self.chunks),
            message_count=sum(self.counts.values()),
            message_end_time=max((c.message_end_time for c in self.chunks), default=0),
            message_start_time=min((c.message_start_time for c in self.chunks), default=0),
            metadata_count=len(self.metadata),
            schema_count=len(self.schemas),
        )


def metadata_crc(name: str, values: Mapping[str, str]) -> str:
    """Return the checksum that a metadata record carries of its name and its other entries."""
    entries = {key: value for key, value in values.items() if key != CRC_KEY}
    return f"{crc32(to_bytes(Metadata(name, entries))):08x}"


@lru_cache(maxsize=256)  # the cells of a sweep say the same about their engine
def _metadata_record(name: str, values: tuple[tuple[str, str], ...]) -> bytes:
    entries = dict(values)
    return to_bytes(Metadata(name, {**entries, CRC_KEY: metadata_crc(name, entries)}))


@lru_cache(maxsize=4)  # the cells of a sweep have one text as written
def _attachment_record(name: str, media_type: str, data: bytes) -> bytes:
    return to_bytes(Attachment(0, 0, name, media_type, data))


class Registered(NamedTuple):
    """Schemas, and the channels that need them, as records."""

    schemas: tuple[Schema, ...]
    channels: tuple[Channel, ...]
    schema_data: bytes
    channel_data: bytes

    @classmethod
    def of(cls, schemas: Iterable[Schema], channels: Iterable[Channel]) -> Registered:
        """Encode the records."""
        schemas, channels = tuple(schemas), tuple(channels)
        return cls(schemas, channels, to_bytes(*schemas), to_bytes(*channels))

    @property
    def data(self) -> bytes:
        """All records: what opens the chunk that needs them."""
        return self.schema_data + self.channel_data


class Closed(NamedTuple):
    """A chunk that takes no more messages, ready to be written."""

    chunk: Chunk
    messages: list[Messages]


def _compressor() -> zstandard.ZstdCompressor:
    """Return the compressor of this thread; its tables are made once, and change no byte."""
    own = getattr(_of_thread, "compressor", None)
    if own is None:
        own = _of_thread.compressor = zstandard.ZstdCompressor(level=COMPRESSION_LEVEL)
    return own


def closed(payload: bytes | memoryview, messages: Iterable[Messages]) -> Closed:
    """Return the compressed chunk of some messages; may be called from any thread."""
    messages = [group for group in messages if len(group.entries)]
    chunk = Chunk(
        compression="zstd",
        data=_compressor().compress(payload),
        message_start_time=min(int(group.entries["time"][0]) for group in messages),
        message_end_time=max(int(group.entries["time"][-1]) for group in messages),
        uncompressed_crc=crc32(payload),
        uncompressed_size=len(payload),
    )
    return Closed(chunk, messages)


def message_index(messages: Messages) -> bytes:
    """Return a MessageIndex record; mcap's own writes entry by entry."""
    entries = messages.entries.astype(INDEX_ENTRY, copy=False).tobytes()
    size = len(entries)
    return _MESSAGE_INDEX(Opcode.MESSAGE_INDEX, 6 + size, messages.channel, size) + entries


class Container:
    """An MCAP file being written."""

    def __init__(self, path: Path) -> None:
        self.index = FileIndex()
        self._path = path
        self._stream = path.open("wb", buffering=0)  # short records are joined here
        self._unwritten: list[bytes] = []  # records that go with the next chunk
        self._summed: list[bytes] = []  # of them, those that are in the checksums
        self._registered: list[Registered] = []
        self._crc = 0
        self._sha256 = FileDigest()
        self._offset = 0
        self._write(MAGIC + to_bytes(Header(profile="", library=LIBRARY)))

    def attach(self, name: str, media_type: str, data: bytes) -> None:
        """Write an attachment; its times are 0, for no wall clock enters the file."""
        record = _attachment_record(name, media_type, data)
        entry = AttachmentIndex(self._offset, len(record), 0, 0, len(data), name, media_type)
        self.index.attachments.append(entry)
        self._write(record)

    def describe(self, name: str, values: Mapping[str, str]) -> None:
        """Write a metadata record with its checksum. ValueError when `values` has that key."""
        if CRC_KEY in values:
            raise ValueError(f"metadata {name!r} may not use the key {CRC_KEY!r}")
        record = _metadata_record(name, tuple(values.items()))
        self.index.metadata.append(MetadataIndex(self._offset, len(record), name))
        self._write(record)

    def register(self, records: Registered) -> None:
        """Note schemas and channels for the summary; their records open a chunk."""
        self.index.schemas.update({schema.id: schema for schema in records.schemas})
        self.index.channels.update({channel.id: channel for channel in records.channels})
        self._registered.append(records)

    def write_chunk(self, one: Closed, flush: bool = True) -> None:
        """Write a chunk with its message indexes; flush: now, not with what is written next."""
        chunk, messages = one.chunk, one.messages
        *head, data = pieces_of(chunk)
        opening = b"".join(head)
        length = len(opening) + len(data)
        indexes = [message_index(group) for group in messages]
        position = self._offset + length
        offsets = {}
        for group, index in zip(messages, indexes, strict=True):
            offsets[group.channel] = position
            position += len(index)
            count = self.index.counts.get(group.channel, 0) + len(group.entries)
            self.index.counts[group.channel] = count
        entry = index_of(chunk, self._offset, length)
        entry.message_index_offsets = offsets
        entry.message_index_length = position - self._offset - length
        self.index.chunks.append(entry)
        for piece in (opening, data, *indexes):
            self._write(piece)
        if flush:
            self._flush()

    def finish(self) -> LogDigest:
        """Write DataEnd, the summary and the footer, and close the file; returns what it is."""
        records = self.crc
        self._write(to_bytes(DataEnd(records)))
        start = self._offset
        index = self.index
        groups = [
            (Opcode.SCHEMA, b"".join(one.schema_data for one in self._registered)),
            (Opcode.CHANNEL, b"".join(one.channel_data for one in self._registered)),
            (Opcode.STATISTICS, to_bytes(index.statistics())),
            (Opcode.CHUNK_INDEX, to_bytes(*index.chunks)),
            (Opcode.ATTACHMENT_INDEX, to_bytes(*index.attachments)),
            (Opcode.METADATA_INDEX, to_bytes(*index.metadata)),
        ]
        summary = b""
        offsets = []
        for opcode, data in groups:
            offsets.append(SummaryOffset(opcode, start + len(summary), len(data)))
            summary += data
        offset_start = start + len(summary)
        summary += to_bytes(*(offset for offset in offsets if offset.group_length))
        footer = to_bytes(Footer(start, offset_start, 0))
        crc = crc32(summary + footer[:-4])
        self._write(summary + to_bytes(Footer(start, offset_start, crc)) + MAGIC)
        self.abandon()
        return LogDigest(self._offset, records, self._sha256.hexdigest())

    @property
    def crc(self) -> int:
        """CRC of all bytes so far; `finish` writes it into DataEnd."""
        self._sum()
        return self._crc

    def abandon(self) -> None:
        """Close the file as it stands: without `finish` it is a killed run."""
        if self._stream.closed:
            return
        try:
            self._flush()
        finally:
            with named(self._path):
                self._stream.close()

    def _write(self, data: bytes) -> None:
        self._unwritten.append(data)
        self._offset += len(data)

    def _sum(self) -> None:
        """Take what was written into the checksums."""
        unwritten, self._unwritten = self._unwritten, []
        for data in _joined(unwritten):
            self._crc = crc32(data, self._crc)
            self._sha256.update(data)
            self._summed.append(data)

    def _flush(self) -> None:
        """Hand what was written to the system: many short records in one call, long ones alone."""
        self._sum()
        summed, self._summed = self._summed, []
        with named(self._path):
            for data in _joined(summed):
                left = memoryview(data)
                while left:
                    left = left[self._stream.write(left) :]


def _joined(pieces: Iterable[bytes]) -> Iterator[bytes]:
    """Yield pieces in their order: long ones as they are, short ones in one."""
    short: list[bytes] = []
    for piece in pieces:
        if len(piece) <= LONG:
            short.append(piece)
            continue
        if short:
            yield b"".join(short)
            short = []
        yield piece
    if short:
        yield b"".join(short)


def index_of(chunk: Chunk, offset: int, length: int) -> ChunkIndex:
    """Return the index entry of a chunk record at `offset`; its message indexes still unknown."""
    return ChunkIndex(
        chunk_start_offset=offset,
        chunk_length=length,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_start_time=chunk.message_start_time,
        message_end_time=chunk.message_end_time,
        message_index_length=0,
        message_index_offsets={},
        uncompressed_size=chunk.uncompressed_size,
    )
