"""A closed log is as it was written to the byte: no byte changes, is cut or exchanged unseen."""

from __future__ import annotations

import hashlib
import io
from pathlib import Path

import pytest
from mcap.writer import Writer

from lavendersim.errors import TraceError
from lavendersim.trace.whole import LogDigest, check_bytes, check_closed, read_end


def log(text: bytes = b"data") -> bytes:
    """Return a small MCAP file, by its own library."""
    stream = io.BytesIO()
    writer = Writer(stream, enable_data_crcs=True)
    writer.start("", "made")
    schema = writer.register_schema("s", "", b"")
    channel = writer.register_channel("/t", "", schema)
    for sequence in range(3):
        writer.add_message(channel, sequence, text, sequence, sequence)
    writer.finish()
    return stream.getvalue()


def digest_of(data: bytes) -> LogDigest:
    """Return what an index says of a log."""
    end = read_end(Path("a.mcap"), io.BytesIO(data))
    return LogDigest(len(data), end.crc, hashlib.sha256(data).hexdigest())


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "a.mcap"
    file.write_bytes(log())
    return file


def test_a_log_as_it_was_written(path: Path) -> None:
    check_closed(path)
    check_bytes(path)
    check_bytes(path, digest_of(path.read_bytes()))


def test_every_byte_counts(path: Path) -> None:
    whole = path.read_bytes()
    for place in range(len(whole)):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x10]) + whole[place + 1 :])
        with pytest.raises(TraceError):
            check_bytes(path)


def test_no_part_of_a_log_is_whole(path: Path) -> None:
    whole = path.read_bytes()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        with pytest.raises(TraceError, match="unfinished, its end is missing"):
            check_closed(path)


def test_another_log_that_is_whole_is_not_the_one_that_was_written(path: Path) -> None:
    expected = digest_of(path.read_bytes())
    path.write_bytes(log(b"DATA"))
    check_bytes(path)  # whole, by itself
    with pytest.raises(TraceError, match="not the log that its run wrote there"):
        check_closed(path, expected)
    wrong = digest_of(path.read_bytes())._replace(sha256=expected.sha256)
    check_closed(path, wrong)  # of equal size and CRC: SHA-256 tells
    with pytest.raises(TraceError, match="not the log that its run wrote there"):
        check_bytes(path, wrong)


def test_what_is_no_log(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="no such log"):
        check_closed(tmp_path / "none.mcap")
    file = tmp_path / "b.mcap"
    file.write_bytes(b"x" * 100 + log()[-8:])
    with pytest.raises(TraceError, match="not an MCAP file"):
        check_closed(file)
