"""Records of a log have the bytes that mcap's own builder gives them."""

from __future__ import annotations

import pytest
from mcap.data_stream import RecordBuilder
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)

from lavendersim.trace.record_bytes import to_bytes

LARGE = 2**63 + 5
RECORDS: list[McapRecord] = [
    Attachment(1, 2, "näme", "text/plain", b"data"),
    AttachmentIndex(1, LARGE, 3, 4, 5, "name", ""),
    Channel(3, "/topic", "cdr", {"one": "1", "zwölf": ""}, 65535),
    Chunk("zstd", b"\0payload", 7, 8, 2**32 - 1, LARGE),
    ChunkIndex(1, 2, "zstd", 3, 4, 5, {6: 7, 8: LARGE}, 9, 10),
    DataEnd(2**32 - 1),
    Footer(LARGE, 0, 1),
    Header("", "lavender"),
    Metadata("name", {"key": "välue", "": ""}),
    MetadataIndex(1, 2, "name"),
    Schema(1, b"\1\2", "protobuf", "lavender.Step"),
    Statistics(1, 2, {3: 4, 5: LARGE}, 6, 7, 8, 9, 10, 11),
    SummaryOffset(3, LARGE, 5),
]


@pytest.mark.parametrize("record", RECORDS, ids=lambda one: type(one).__name__)
def test_a_record_has_the_bytes_of_mcap(record: McapRecord) -> None:
    builder = RecordBuilder()
    record.write(builder)
    assert to_bytes(record) == builder.end()  # type: ignore[no-untyped-call]


def test_records_stand_one_after_the_other() -> None:
    assert to_bytes(*RECORDS) == b"".join(map(to_bytes, RECORDS))


def test_every_kind_of_record_that_a_log_is_written_with_is_tried() -> None:
    written = {"MessageIndex", "Message"}  # by kernels and `container.message_index`
    kinds = {kind.__name__ for kind in McapRecord.__subclasses__()} - written
    assert kinds == {type(record).__name__ for record in RECORDS}
