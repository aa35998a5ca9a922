"""The whole part of a killed run's log, found by walking its records from the start.

What is not whole, or fails a check, ends the walk; what counts ends at the last light chunk, for
the writer puts a light chunk behind the other chunks of the same steps.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import NamedTuple

import zstandard
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, AttachmentIndex, Chunk, MetadataIndex

from lavendersim.errors import TraceError
from lavendersim.trace.container import FileIndex, index_of, message_index
from lavendersim.trace.index import (
    PARSERS,
    message_indexes,
    note,
    open_chunk,
    parse,
    parse_metadata,
    spans,
)
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.whole import MAGIC


class Prefix(NamedTuple):
    """The whole part of a killed run: up to the last light chunk, with all that belongs to it."""

    entries: FileIndex
    data: bytes
    lost: int  # bytes behind it
    reason: str  # why it ends there


def scan(path: Path) -> Prefix:
    """Walk a file from its start. TraceError when not even one group of steps is whole."""
    data = path.read_bytes()
    walk = _Walk(data)
    try:
        reason = walk.run()
    except (McapError, zstandard.ZstdError, struct.error, ValueError, MemoryError) as error:
        reason = str(error) or type(error).__name__
    if not walk.whole:
        raise TraceError(f"{path}: nothing to save, no group of steps is whole ({reason})")
    return Prefix(walk.entries, data[: walk.whole], len(data) - walk.whole, reason)


class _Walk:
    """Where a walk stands: what is whole for certain, and what waits for its light chunk."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.entries, self.waiting = FileIndex(), FileIndex()
        self.whole = 0

    def run(self) -> str:
        """Walk; return why it ended. ValueError and the like when a record fails a check."""
        records = list(spans(self.data, len(MAGIC)))
        if not self.data.startswith(MAGIC) or not records or records[0][0] != Opcode.HEADER:
            raise ValueError("the file does not begin as a log")
        position = 1
        while position < len(records):
            opcode, start, end = records[position]
            position += 1
            record = self.data[start:end]
            if opcode == Opcode.ATTACHMENT:
                a = parse(record, Attachment)
                sizes = (start, len(record), a.log_time, a.create_time, len(a.data))
                self.waiting.attachments.append(AttachmentIndex(*sizes, a.name, a.media_type))
            elif opcode == Opcode.METADATA:
                name = parse_metadata(record).name
                self.waiting.metadata.append(MetadataIndex(start, len(record), name))
            elif opcode == Opcode.CHUNK:
                while position < len(records) and records[position][0] == Opcode.MESSAGE_INDEX:
                    position += 1
                stop = records[position - 1][2]
                if _note_chunk(self.waiting, self.data, start, end, stop):
                    _commit(self.entries, self.waiting)
                    self.waiting, self.whole = FileIndex(), stop
            elif opcode == Opcode.DATA_END:
                return "all steps are whole, only the end of the file is damaged"
            else:
                raise ValueError("a record stands where none should")
        return "the file ends before its time"


def _note_chunk(index: FileIndex, data: bytes, start: int, end: int, stop: int) -> bool:
    """Enter a chunk and the message indexes behind it; tell whether it is a light one."""
    chunk: Chunk = parse(data[start:end], Chunk)
    messages = message_indexes(data[end:stop])
    content = open_chunk(chunk, messages)
    entry = index_of(chunk, start, end - start)
    entry.message_index_length = stop - end
    position = end
    for group in messages:
        entry.message_index_offsets[group.channel] = position
        position += len(message_index(group))
        count = index.counts.get(group.channel, 0) + len(group.entries)
        index.counts[group.channel] = count
    index.chunks.append(entry)
    for opcode, first, last in spans(content.prologue):
        note(index, parse(content.prologue[first:last], PARSERS[opcode]))
    return CHANNELS["/step"] in content.messages


def _commit(index: FileIndex, tentative: FileIndex) -> None:
    index.schemas.update(tentative.schemas)
    index.channels.update(tentative.channels)
    index.chunks += tentative.chunks
    index.attachments += tentative.attachments
    index.metadata += tentative.metadata
    for channel, count in tentative.counts.items():
        index.counts[channel] = index.counts.get(channel, 0) + count
