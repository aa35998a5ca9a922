"""What is whole of a damaged log: its groups of steps, attachments and metadata.

A group is the chunks of some steps, and its light chunk stands behind the others (`writer`):

    columns points poses light | columns points poses light | ...

It counts where all of it is there and of its times. Which chunks stood where nothing can be read
the summary says; without one, a stretch that cannot be attributed costs the group behind it.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final, NamedTuple

from mcap.opcode import Opcode
from mcap.records import AttachmentIndex, ChunkIndex, Header, MetadataIndex

from lavendersim.errors import TraceError
from lavendersim.trace.container import LIBRARY, FileIndex
from lavendersim.trace.groups import GEOMETRY, STEP, Group, Groups
from lavendersim.trace.index import read_at, read_summary
from lavendersim.trace.layout import RECORD_HEADER
from lavendersim.trace.limits import check_growth, claimed_by
from lavendersim.trace.rebuild import REFUSALS, rebuilt
from lavendersim.trace.record_bytes import to_bytes
from lavendersim.trace.source import FORMER_RESOLVED
from lavendersim.trace.walk import NOTHING, Found, walk
from lavendersim.trace.whole import MAGIC
from lavendersim.trace.wire import NANOSECONDS
from lavendersim.trace.writer import AS_WRITTEN, DESCRIPTION, ENDING, RESOLVED

HEAD: Final = len(MAGIC) + len(to_bytes(Header(profile="", library=LIBRARY)))


class Remaining(NamedTuple):
    """What is whole of a log."""

    entries: FileIndex  # of chunks by their channels
    groups: list[Group]
    lost: list[str]  # what is not there, each in words
    ended: bool  # the log says how the run ended
    crc: int | None  # of all bytes before DataEnd, where that is whole


def scan(path: Path) -> Remaining:
    """Return what is whole of a damaged log. TraceError where not one group of steps is."""
    try:
        summary = read_summary(path)
    except TraceError:
        summary = FileIndex()
    with path.open("rb") as stream:
        found = _Scan(path, stream, summary)
        for record, indexes in _with_indexes(walk(stream)):
            found.take(record, indexes)
    if not found.groups.whole:
        raise TraceError(f"{path}: nothing to save, no group of steps is whole")
    return Remaining(found.entries, found.groups.whole, found.lost(), found.ended, found.crc)


def _with_indexes(records: Iterator[Found]) -> Iterator[tuple[Found, list[Found]]]:
    """Yield all but message indexes, each with the message indexes that stand behind it."""
    last: Found | None = None
    indexes: list[Found] = []
    for found in records:
        if found.opcode == Opcode.MESSAGE_INDEX:
            indexes.append(found)
            continue
        if last is not None:
            yield last, indexes
        last, indexes = found, []
    if last is not None:
        yield last, indexes


class _Scan:
    """Where a walk stands: what is whole so far."""

    def __init__(self, path: Path, stream: BinaryIO, summary: FileIndex) -> None:
        self._stream, self._summary = stream, summary
        self._size = stream.seek(0, 2)
        self._claimed = 0  # bytes of all chunks so far, decompressed
        self.entries = FileIndex(dict(summary.schemas), dict(summary.channels))
        self.groups = Groups(path, self.entries)
        self.crc: int | None = None
        self.ended = False
        self._expected = HEAD  # up to there nothing is lost but what can be made again
        self._described = 0  # bytes that are lost before the first chunk
        self._unclear = False  # a stretch that may have been a chunk

    def take(self, found: Found, indexes: list[Found]) -> None:
        """Go on by one stretch of the file, and the message indexes behind it."""
        length = found.end - found.start
        if found.opcode == Opcode.CHUNK:
            self._take_chunk(found, indexes)
        elif found.opcode == Opcode.ATTACHMENT:
            a = found.record
            sizes = (found.start, length, a.log_time, a.create_time, len(a.data))
            self.entries.attachments.append(AttachmentIndex(*sizes, a.name, a.media_type))
            self._unclear = False
        elif found.opcode == Opcode.METADATA:
            name = found.record.name
            self.entries.metadata.append(MetadataIndex(found.start, length, name))
            self.ended = self.ended or name == ENDING
            self._unclear = self._unclear and name == ENDING
        elif found.opcode == Opcode.DATA_END:
            self.crc = found.record.data_section_crc
        elif found.opcode == NOTHING and found.end > self._expected:
            self._lose(found, indexes)

    def _take_chunk(self, found: Found, indexes: list[Found]) -> None:
        end = indexes[-1].end if indexes else found.end
        behind = read_at(self._stream, found.end, end - found.end)
        self._claimed += claimed_by(found.record)
        check_growth(self._claimed, self._size, "its chunks")
        try:
            one = rebuilt(found.record, behind)
        except REFUSALS:
            self._lose(found, indexes)
            return
        if self._unclear and one.content.messages.keys() != GEOMETRY:  # that is the first chunk
            self.groups.lose(frozenset())
        self._unclear = False
        self._expected = found.end + one.index_length
        entry = ChunkIndex(
            chunk_start_offset=found.start,
            chunk_length=found.end - found.start,
            compression=one.chunk.compression,
            compressed_size=len(one.chunk.data),
            message_start_time=one.chunk.message_start_time,
            message_end_time=one.chunk.message_end_time,
            message_index_length=len(behind),
            message_index_offsets=dict.fromkeys(one.content.messages, 0),
            uncompressed_size=one.chunk.uncompressed_size,
        )
        self.groups.take(entry, one.content)

    def _lose(self, found: Found, indexes: list[Found]) -> None:
        """Note which chunks stood in a stretch that is none of their own."""
        if not self.entries.chunks and not self.groups.unfinished:
            self._described += found.end - found.start
        if self._summary.chunks:
            for entry in self._summary.chunks:
                if found.start <= entry.chunk_start_offset < found.end:
                    self.groups.lose(frozenset(entry.message_index_offsets))
        elif indexes:
            heads = (read_at(self._stream, one.start + RECORD_HEADER, 2) for one in indexes)
            self.groups.lose(frozenset(int.from_bytes(head, "little") for head in heads))
        else:
            self._unclear = True

    def lost(self) -> list[str]:
        """Return what is not there, in words."""
        words = [*self._lost_descriptions(), *self._lost_steps()]
        return words if self.ended else [*words, "how the run ended"]

    def _lost_descriptions(self) -> Iterator[str]:
        found = {entry.name for entry in self.entries.attachments}
        found |= {entry.name for entry in self.entries.metadata}
        summary = self._summary
        if not summary.chunks:
            if AS_WRITTEN not in found:
                yield f"attachment {AS_WRITTEN}"
            if found.isdisjoint({RESOLVED, FORMER_RESOLVED}):
                yield f"attachment {RESOLVED}"
            if DESCRIPTION not in found:
                yield f"metadata {DESCRIPTION!r}"
            if self._described and {AS_WRITTEN, RESOLVED, DESCRIPTION} <= found:
                yield f"{self._described} bytes before the first step"
        attachments = (entry.name for entry in summary.attachments)
        yield from (f"attachment {name}" for name in attachments if name not in found)
        metadata = (entry.name for entry in summary.metadata)
        yield from (f"metadata {name!r}" for name in metadata if name not in found | {ENDING})
        (geometry,) = GEOMETRY
        if geometry in summary.counts and geometry not in self.entries.counts:
            yield "the scene's shapes, /robot_description"

    def _lost_steps(self) -> Iterator[str]:
        before, time = 0, 0
        for group in self.groups.whole:
            if group.first > before:
                yield _steps(before, group.first - 1, time, group.begin)
            before, time = group.last + 1, group.end
        total = self._summary.counts.get(STEP)
        if total is not None and total > before:
            end = max(entry.message_end_time for entry in self._summary.chunks)
            yield _steps(before, total - 1, time, end)
        elif total is None and (self.groups.unfinished or self._unclear or not self.ended):
            yield f"what followed step {before - 1} (t = {time / NANOSECONDS:.9g} s)"


def _steps(first: int, last: int, begin: int, end: int) -> str:
    span = f"t = {begin / NANOSECONDS:.9g} to {end / NANOSECONDS:.9g} s"
    return f"steps {first} to {last} ({span})" if last > first else f"step {first} ({span})"
