"""Sample logs for tests of single modules: the file, what went into it, and its chunks."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import ChunkIndex, McapRecord
from mcap.stream_reader import StreamReader
from sample import run, write

from lavendersim.trace import Block
from lavendersim.trace.container import FileIndex
from lavendersim.trace.index import ChunkContent, read_chunk, read_summary
from lavendersim.trace.layout import CHANNELS


class Logged(NamedTuple):
    """A log of a sample run."""

    path: Path
    block: Block
    index: FileIndex

    def chunks(self, topic: str | None = None) -> Iterator[tuple[ChunkIndex, ChunkContent]]:
        """Yield the chunks, of a topic or all."""
        with self.path.open("rb") as stream:
            for entry in self.index.chunks:
                if topic is None or CHANNELS[topic] in entry.message_index_offsets:
                    yield entry, read_chunk(stream, entry)


def logged(path: Path, steps: int = 60, block: Block | None = None, **options: Any) -> Logged:
    """Write a sample run and return its log."""
    block = run(steps) if block is None else block
    write(path, [block], **options)
    return Logged(path, block, read_summary(path))


def messages(path: Path, topic: str) -> Iterator[tuple[Any, Any]]:
    """Yield the messages of a topic, read by mcap and google.protobuf, with their records."""
    classes: dict[int, Any] = {}
    with path.open("rb") as stream:
        for schema, _, message in make_reader(stream).iter_messages(topics=[topic]):
            assert schema is not None
            if schema.id not in classes:
                pool = descriptor_pool.DescriptorPool()
                for file in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                    pool.Add(file)
                found = pool.FindMessageTypeByName(schema.name)
                classes[schema.id] = message_factory.GetMessageClass(found)
            yield message, classes[schema.id].FromString(message.data)


def records(data: bytes, magic: bool = False) -> list[McapRecord]:
    """Return the records that some bytes begin with, read by mcap; chunks are not opened."""
    reader = StreamReader(BytesIO(data), skip_magic=not magic, emit_chunks=True)
    found: list[McapRecord] = []
    with suppress(EndOfFile):  # no footer ends them
        found.extend(reader.records)
    return found
