"""A chunk by its compressed bytes alone: what damage to its header or its indexes cannot touch.

The CRC of a chunk is over its payload. Times, size and message indexes, which stand around it, are
made again from that payload where they do not fit it.
"""

from __future__ import annotations

import struct
from typing import Any, BinaryIO, Final, NamedTuple

import numpy as np
import zstandard
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk, ChunkIndex
from numpy.typing import NDArray

from lavendersim.trace.container import Messages, message_index
from lavendersim.trace.index import (
    MESSAGE,
    ChunkContent,
    message_indexes,
    open_chunk,
    parse,
    read_at,
    records_of,
)
from lavendersim.trace.layout import RECORD_HEADER
from lavendersim.trace.limits import check_chunk
from lavendersim.trace.wire import INDEX_ENTRY, gather

REFUSALS: Final = (
    *(McapError, zstandard.ZstdError, struct.error, EOFError),
    *(ValueError, KeyError, IndexError, MemoryError, OverflowError),
)
_HEAD: Final = struct.Struct("<HIQ")  # channel, sequence and log time of a message


class Rebuilt(NamedTuple):
    """A chunk whose payload is whole."""

    chunk: Chunk  # as it was written
    content: ChunkContent
    index_length: int  # of its message indexes as they were written


def rebuilt(chunk: Chunk, indexes: bytes) -> Rebuilt:
    """Return a chunk as it was written; indexes: what stands behind it.

    One of REFUSALS when its payload fails its CRC, or is no sequence of messages.
    """
    size = zstandard.frame_content_size(chunk.data)
    if size < 0:
        raise ValueError("a chunk has no size")
    chunk.uncompressed_size = size
    check_chunk(chunk)
    try:
        content = open_chunk(chunk, message_indexes(indexes))
    except REFUSALS:
        content = open_chunk(chunk, _messages_in(chunk))
    times = np.concatenate([entries["time"] for entries in content.messages.values()])
    chunk.message_start_time, chunk.message_end_time = int(times.min()), int(times.max())
    length = sum(len(message_index(Messages(*one))) for one in content.messages.items())
    return Rebuilt(chunk, content, length)


def rebuilt_at(stream: BinaryIO, entry: ChunkIndex) -> Rebuilt:
    """Return the chunk that an index entry points to, however damaged what stands around it is."""
    chunk = parse(read_at(stream, entry.chunk_start_offset, entry.chunk_length), Chunk)
    behind = entry.chunk_start_offset + entry.chunk_length
    return rebuilt(chunk, read_at(stream, behind, entry.message_index_length))


def _messages_in(chunk: Chunk) -> list[Messages]:
    """Return the message indexes of a chunk by its messages."""
    payload = zstandard.ZstdDecompressor().decompress(chunk.data, chunk.uncompressed_size)
    found: dict[int, list[tuple[int, int]]] = {}
    for opcode, start, _ in records_of(payload):
        if opcode == Opcode.MESSAGE:
            channel, _, time = _HEAD.unpack_from(payload, start + RECORD_HEADER)
            found.setdefault(channel, []).append((time, start))
    groups = sorted(found.items())
    return [Messages(channel, np.array(rows, INDEX_ENTRY)) for channel, rows in groups]


def sequences_of(content: ChunkContent, channel: int) -> NDArray[Any]:
    """Return the sequences, which are steps, of the messages of a channel."""
    offsets = content.messages[channel]["offset"].astype(np.int64)
    heads = gather(content.data, offsets, MESSAGE.itemsize).view(MESSAGE)[:, 0]
    steps: NDArray[Any] = heads["sequence"].astype(np.int64)
    return steps
