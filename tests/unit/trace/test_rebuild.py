"""A chunk by its compressed bytes alone: header and indexes are made again as they were."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from logs_of_samples import Logged, logged
from mcap.records import Chunk

from lavendersim.trace.index import ChunkContent, parse, read_at
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.rebuild import REFUSALS, rebuilt, rebuilt_at, sequences_of


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap")


def parts(log: Logged, number: int) -> tuple[Chunk, bytes]:
    entry, stream = log.index.chunks[number], BytesIO(log.path.read_bytes())
    chunk = parse(read_at(stream, entry.chunk_start_offset, entry.chunk_length), Chunk)
    behind = entry.chunk_start_offset + entry.chunk_length
    return chunk, read_at(stream, behind, entry.message_index_length)


def same(one: ChunkContent, other: ChunkContent) -> bool:
    return (
        one.data.tobytes() == other.data.tobytes()
        and one.prologue == other.prologue
        and one.messages.keys() == other.messages.keys()
        and all(one.messages[c].tobytes() == other.messages[c].tobytes() for c in one.messages)
    )


def test_times_size_and_indexes_are_made_again(log: Logged) -> None:
    for number, (entry, content) in enumerate(log.chunks()):
        chunk, indexes = parts(log, number)
        whole = (chunk.message_start_time, chunk.message_end_time, chunk.uncompressed_size)
        chunk.message_start_time, chunk.message_end_time, chunk.uncompressed_size = 9, 3, 1
        for behind in (indexes, indexes[:-1], b"", bytes(len(indexes))):
            one = rebuilt(chunk, behind)
            assert same(one.content, content)
            again = one.chunk
            assert (
                again.message_start_time,
                again.message_end_time,
                again.uncompressed_size,
            ) == whole
            assert one.index_length == entry.message_index_length


def test_a_payload_that_changed_is_refused(log: Logged) -> None:
    random = np.random.default_rng(0)
    for number in range(len(log.index.chunks)):
        for _ in range(20):
            chunk, indexes = parts(log, number)
            data = bytearray(chunk.data)
            data[random.integers(len(data))] ^= 1 << random.integers(8)
            chunk.data = bytes(data)
            try:
                one = rebuilt(chunk, indexes)
            except REFUSALS:
                continue
            # a bit of the frame's header that says nothing about its content
            (content,) = (c for k, (_, c) in enumerate(log.chunks()) if k == number)
            assert same(one.content, content)


def test_a_chunk_is_found_by_its_entry_although_its_index_is_gone(log: Logged) -> None:
    data = bytearray(log.path.read_bytes())
    entry = log.index.chunks[-1]
    behind = entry.chunk_start_offset + entry.chunk_length
    data[behind : behind + entry.message_index_length] = bytes(entry.message_index_length)
    one = rebuilt_at(BytesIO(bytes(data)), entry)
    *_, (_, content) = log.chunks()
    assert same(one.content, content)


def test_sequences_are_the_steps(log: Logged) -> None:
    ((_, content),) = log.chunks("/step")
    steps = sequences_of(content, CHANNELS["/step"])
    assert steps.tolist() == log.block.step["step"].tolist()
    ((_, points),) = log.chunks("/contacts")
    assert sequences_of(points, CHANNELS["/contacts"]).tolist() == list(range(len(log.block.step)))


def test_a_frame_without_a_size_is_no_chunk(log: Logged, tmp_path: Path) -> None:
    import zstandard

    stream = zstandard.ZstdCompressor().compressobj()
    chunk, indexes = parts(log, 0)
    chunk.data = stream.compress(b"x") + stream.flush()
    with pytest.raises(ValueError, match="no size"):
        rebuilt(chunk, indexes)
