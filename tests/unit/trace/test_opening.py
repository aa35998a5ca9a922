"""Opening logs: refused where they are not whole, in part where that is allowed, of one cell."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from sample import CONFIG, run, write

from lavendersim.errors import TraceError
from lavendersim.trace import open_trace
from lavendersim.trace.whole import ExpectedLog, LogDigest

CELL = hashlib.sha256(CONFIG.as_json().encode()).hexdigest()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return write(tmp_path / "a.mcap", [run(900)])


def digest_of(path: Path) -> LogDigest:
    """Return size, CRC and SHA-256; the CRC stands in DataEnd, 13 bytes before the summary."""
    data = path.read_bytes()
    start = int.from_bytes(data[-28:-20], "little")  # of the summary, by the footer
    crc = int.from_bytes(data[start - 4 : start], "little")
    return LogDigest(len(data), crc, hashlib.sha256(data).hexdigest())


def test_a_whole_log_of_its_cell_is_opened(path: Path) -> None:
    trace = open_trace(path, expected=ExpectedLog(CELL, digest_of(path)))
    trace.verify()
    assert trace.complete
    assert trace.damage == ""
    assert open_trace(path, config=CONFIG).config is CONFIG


def test_what_is_not_there_and_what_is_not_ended(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"none\.mcap: no such log$"):
        open_trace(tmp_path / "none.mcap")
    killed = write(tmp_path / "killed.mcap", [run(900)], status=None)
    with pytest.raises(TraceError, match="unfinished, its end is missing"):
        open_trace(killed)
    part = open_trace(killed, allow_incomplete=True)
    assert (part.status, part.complete) == ("incomplete", False)
    assert "unfinished" in part.damage
    assert 0 < len(part.step) < 900


def test_a_changed_byte_is_found_when_a_column_is_read_or_at_once(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    trace = open_trace(path)  # its summary is whole
    with pytest.raises(TraceError, match="CRC"):
        trace.step  # noqa: B018
    part = open_trace(path, allow_incomplete=True)
    assert part.damage
    assert len(part.step) < 900


def test_another_log_in_its_place_is_refused(path: Path, tmp_path: Path) -> None:
    expected = ExpectedLog(CELL, digest_of(path))
    other = write(tmp_path / "b.mcap", [run(900, seed=1)])
    with pytest.raises(TraceError, match="not the log that its run wrote there"):
        open_trace(other, expected=expected)
    foreign = ExpectedLog("0" * 64)
    with pytest.raises(TraceError, match="the log of another cell"):
        open_trace(path, expected=foreign).verify()
    with pytest.raises(TraceError, match="the log of another cell"):
        open_trace(path, allow_incomplete=True, expected=foreign)


@pytest.mark.parametrize("allowed", [False, True])
def test_what_was_recovered_of_the_expected_log_is_said_to_be_a_part(
    path: Path, tmp_path: Path, allowed: bool
) -> None:
    expected = ExpectedLog(CELL, digest_of(path))
    saved = write(tmp_path / "saved.mcap", [run(400)], status="recovered: 400 steps")
    if allowed:
        assert len(open_trace(saved, allow_incomplete=True, expected=expected).step) == 400
    else:
        with pytest.raises(TraceError, match="recovered: 400 steps; it is no whole log"):
            open_trace(saved, expected=expected)
