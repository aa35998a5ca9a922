"""What stands where in a log: a changed byte of any record, index or chunk is refused."""

from __future__ import annotations

import struct
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from logs_of_samples import Logged, logged
from mcap.records import Attachment, Channel, Chunk, Metadata, Schema

from lavendersim.errors import TraceError
from lavendersim.trace.container import Messages, message_index, metadata_crc
from lavendersim.trace.index import (
    MOST_DESCRIPTIONS,
    damage,
    message_indexes,
    open_chunk,
    parse,
    parse_metadata,
    read_at,
    read_chunk,
    read_summary,
    records_of,
    spans,
)
from lavendersim.trace.record_bytes import to_bytes
from lavendersim.trace.whole import LogDigest
from lavendersim.trace.wire import INDEX_ENTRY

CHANNEL = Channel(3, "/a", "cdr", {"x": "of it [m]"}, 1)
ATTACHMENT = Attachment(0, 0, "config.yaml", "application/yaml", b"question: ?")


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap")


def refused(read: Callable[[bytes], Any], data: bytes) -> bool:
    try:
        read(data)
    except Exception:  # what broken bytes raise is turned into one error by `damage`
        return True
    return False


def test_a_record_is_what_writing_it_again_gives() -> None:
    for record in (CHANNEL, Schema(1, b"data", "cdr", "name"), ATTACHMENT):
        data = to_bytes(record)
        assert parse(data, type(record)) == record
        assert refused(lambda one, record=record: parse(one, Schema if record is CHANNEL else Channel), data)  # noqa: E501  # fmt: skip
        assert refused(lambda one, record=record: parse(one, type(record)), data + b"\0")


def test_every_byte_of_an_attachment_counts() -> None:
    data = to_bytes(ATTACHMENT)
    for place in range(len(data)):
        changed = bytearray(data)
        changed[place] ^= 1
        assert refused(lambda one: parse(one, Attachment), bytes(changed)), place


def test_metadata_carries_a_checksum_of_its_own() -> None:
    values = {"a": "1"}
    whole = Metadata("trace", {**values, "crc32": metadata_crc("trace", values)})
    assert parse_metadata(to_bytes(whole)) == whole
    for broken in (Metadata("trace", values), Metadata("trice", dict(whole.metadata))):
        with pytest.raises(ValueError, match="fails its check"):
            parse_metadata(to_bytes(broken))


def test_spans_are_whole_records_and_stop_where_one_is_cut() -> None:
    records = [to_bytes(CHANNEL), to_bytes(ATTACHMENT)]
    ends = [len(records[0]), sum(map(len, records))]
    found = list(spans(b"".join(records)))
    assert [(one.start, one.end) for one in found] == [(0, ends[0]), (ends[0], ends[1])]
    assert len(list(spans(b"".join(records)[:-1]))) == 1
    with pytest.raises(ValueError, match="none of a chunk"):
        list(records_of(b"".join(records)))
    many = to_bytes(CHANNEL) * (MOST_DESCRIPTIONS + 1)
    assert len(list(records_of(many[: -len(records[0])]))) == MOST_DESCRIPTIONS
    with pytest.raises(ValueError, match="none of a chunk"):
        list(records_of(many))


def test_a_summary_says_what_the_writer_wrote(log: Logged) -> None:
    size, digest = log.path.stat().st_size, LogDigest(1, 2, "3")
    assert log.index.chunks[0].chunk_start_offset > 0
    assert log.index.counts[4] == len(log.block.step)
    assert [one.name for one in log.index.attachments] == ["config.yaml", "resolved.json"]
    with pytest.raises(TraceError, match=rf"it has {size} bytes"):
        read_summary(log.path, digest)


def test_a_chunk_that_contradicts_its_index_is_refused(log: Logged) -> None:
    data = log.path.read_bytes()
    entry = log.index.chunks[1]
    end = entry.chunk_start_offset + entry.chunk_length + entry.message_index_length
    read_chunk(BytesIO(data), entry)
    random = np.random.default_rng(0)
    for place in random.integers(entry.chunk_start_offset, end, 200).tolist():
        changed = bytearray(data)
        changed[place] ^= 0x10
        assert refused(lambda one: read_chunk(BytesIO(one), entry), bytes(changed)), place


@pytest.mark.parametrize("change", ["gap", "time", "channel", "outside", "overlap", "none"])
def test_messages_tile_their_chunk(log: Logged, change: str) -> None:
    """Indexes that are whole records, and say something else than the payload does."""
    data = log.path.read_bytes()
    entry = next(one for one in log.index.chunks if 4 in one.message_index_offsets)
    at = entry.chunk_start_offset + entry.chunk_length
    stream = BytesIO(data)
    chunk = parse(read_at(stream, entry.chunk_start_offset, entry.chunk_length), Chunk)
    groups = message_indexes(read_at(stream, at, entry.message_index_length))
    groups = [Messages(channel, entries.copy()) for channel, entries in groups]
    first = groups[0]
    if change == "gap":
        groups[0] = Messages(first.channel, first.entries[:-1])
    elif change == "time":
        first.entries["time"][2] += 1
    elif change == "channel":
        groups[0] = Messages(99, first.entries)
    elif change == "outside":
        first.entries["offset"][2] = 2**40
    elif change == "overlap":
        first.entries["offset"][2] += 1
    if change == "none":
        assert open_chunk(chunk, groups).messages.keys() == {group.channel for group in groups}
    else:
        with pytest.raises(ValueError, match="message index"):
            open_chunk(chunk, groups)


def test_message_indexes_are_whole_or_none() -> None:
    one = message_index(Messages(4, np.array([(1, 2), (3, 4)], INDEX_ENTRY)))
    (found,) = message_indexes(one)
    assert (found.channel, found.entries.tolist()) == (4, [(1, 2), (3, 4)])
    assert refused(message_indexes, one[:-1])
    longer = one[:11] + struct.pack("<I", 16) + one[15:]
    assert refused(message_indexes, longer)


def test_no_byte_beyond_the_end_is_read() -> None:
    stream = BytesIO(b"0123456789")
    assert read_at(stream, 8, 2) == b"89"
    for offset, length in ((8, 3), (0, -1), (11, 0)):
        with pytest.raises(ValueError, match="too short"):
            read_at(stream, offset, length)


def test_damage_names_the_file_and_what_is_wrong() -> None:
    for error, why in ((ValueError("why"), "why"), (EOFError(), "EOFError")):
        said = rf"^a\.mcap: the summary is damaged \({why}\)$"
        with pytest.raises(TraceError, match=said), damage(Path("a.mcap"), "the summary"):
            raise error
