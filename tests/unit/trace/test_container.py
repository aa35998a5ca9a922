"""The container against mcap's own reader: records, indexes, counts, checksums, a killed file."""

from __future__ import annotations

import hashlib
import zlib
from pathlib import Path

import numpy as np
import pytest
from logs_of_samples import records
from mcap.reader import make_reader
from mcap.records import Channel, DataEnd, Message, Schema

from lavendersim.trace.container import (
    CRC_KEY,
    Closed,
    Container,
    Messages,
    Registered,
    closed,
    metadata_crc,
)
from lavendersim.trace.record_bytes import to_bytes
from lavendersim.trace.whole import LogDigest
from lavendersim.trace.wire import INDEX_ENTRY

RECORDS = Registered.of([Schema(1, b"x", "text", "Text")], [Channel(1, "/a", "text", {}, 1), Channel(2, "/b", "text", {}, 1)])  # noqa: E501  # fmt: skip


def chunk(times: list[int], prologue: bytes = b"") -> Closed:
    """Return a chunk with a message of both channels at each time, and one channel without any."""
    payload, entries = prologue, {1: [], 2: [], 3: []}
    for time in times:
        for channel in (1, 2):
            entries[channel].append((time, len(payload)))
            payload += to_bytes(Message(channel, time, f"{channel}@{time}".encode(), time, time))
    groups = [Messages(c, np.array(rows, INDEX_ENTRY)) for c, rows in entries.items()]
    return closed(payload, groups)


def write(path: Path) -> LogDigest:
    container = Container(path)
    container.attach("config.yaml", "application/yaml", b"question: ?")
    container.describe("trace", {"format": "1"})
    container.register(RECORDS)
    container.write_chunk(chunk([1, 5], RECORDS.data))
    container.write_chunk(chunk([7]), flush=False)
    return container.finish()


def test_mcaps_reader_finds_every_message_and_every_checksum_right(tmp_path: Path) -> None:
    write(tmp_path / "a.mcap")
    with (tmp_path / "a.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        found = [(c.topic, m.log_time, m.data) for _, c, m in reader.iter_messages()]
        summary = reader.get_summary()
        (attachment,) = reader.iter_attachments()
        (metadata,) = reader.iter_metadata()
    expected = [
        (t, at, f"{n}@{at}".encode()) for at in (1, 5, 7) for n, t in ((1, "/a"), (2, "/b"))
    ]
    assert sorted(found) == sorted(expected)
    assert (attachment.name, attachment.data) == ("config.yaml", b"question: ?")
    assert metadata.metadata == {"format": "1", CRC_KEY: metadata_crc("trace", {"format": "1"})}
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.channel_message_counts == {1: 3, 2: 3}
    assert (summary.statistics.message_start_time, summary.statistics.message_end_time) == (1, 7)
    assert [set(one.message_index_offsets) for one in summary.chunk_indexes] == [{1, 2}, {1, 2}]


def test_the_digest_is_of_the_file(tmp_path: Path) -> None:
    digest = write(tmp_path / "a.mcap")
    data = (tmp_path / "a.mcap").read_bytes()
    assert (digest.size, digest.sha256) == (len(data), hashlib.sha256(data).hexdigest())
    (end,) = (one for one in records(data, magic=True) if isinstance(one, DataEnd))
    before = data.index(to_bytes(end))
    assert digest.crc == end.data_section_crc == zlib.crc32(data[:before])


def test_equal_calls_give_equal_bytes(tmp_path: Path) -> None:
    assert write(tmp_path / "a.mcap") == write(tmp_path / "b.mcap")


def test_a_flushed_chunk_is_on_the_disk_and_one_that_is_not_comes_with_what_follows(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.mcap"
    container = Container(path)
    container.register(RECORDS)
    container.write_chunk(chunk([1], RECORDS.data))
    flushed = path.stat().st_size
    container.write_chunk(chunk([2]), flush=False)
    assert path.stat().st_size == flushed > 0
    container.abandon()
    container.abandon()  # twice does no harm
    names = [type(record).__name__ for record in records(path.read_bytes(), magic=True)]
    assert names.count("Chunk") == 2
    assert "Footer" not in names


def test_a_checksum_of_metadata_is_of_its_name_and_all_entries() -> None:
    base = metadata_crc("trace", {"a": "1", "b": "2"})
    assert base == metadata_crc("trace", {"a": "1", "b": "2", CRC_KEY: "anything"})
    changed = [
        ("trac", {"a": "1", "b": "2"}),
        ("trace", {"a": "1", "b": "3"}),
        ("trace", {"a": "1"}),
    ]
    assert all(metadata_crc(*one) != base for one in changed)


def test_the_key_of_the_checksum_is_taken(tmp_path: Path) -> None:
    container = Container(tmp_path / "a.mcap")
    with pytest.raises(ValueError, match="may not use the key"):
        container.describe("trace", {CRC_KEY: "0"})
    container.abandon()
