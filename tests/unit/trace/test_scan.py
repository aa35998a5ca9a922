"""What is whole of a damaged log, and what is lost of it in words: steps, times, descriptions."""

from __future__ import annotations

from pathlib import Path

import pytest
from logs_of_samples import Logged, logged

from lavendersim.errors import TraceError
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.scan import HEAD, scan

STEPS = 901


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Logged:
    return logged(tmp_path_factory.mktemp("log") / "a.mcap", STEPS)


def damaged(log: Logged, folder: Path, *stretches: tuple[int, int], end: int | None = None) -> Path:
    data = bytearray(log.path.read_bytes())
    for begin, length in stretches:
        data[begin : begin + length] = b"\xff" * length
    path = folder / "damaged.mcap"
    path.write_bytes(data[:end])
    return path


def test_of_a_whole_log_nothing_is_lost(log: Logged) -> None:
    found = scan(log.path)
    assert found.lost == []
    assert found.ended
    assert found.crc is not None
    assert found.entries.counts == log.index.counts
    assert [one.chunk_start_offset for one in found.entries.chunks] == [
        one.chunk_start_offset for one in log.index.chunks
    ]
    assert found.entries.attachments == log.index.attachments
    assert found.entries.metadata == log.index.metadata
    assert (found.groups[0].first, found.groups[-1].last) == (0, STEPS - 1)


def test_a_chunk_of_poses_costs_the_steps_of_its_group(log: Logged, tmp_path: Path) -> None:
    whole = scan(log.path).groups
    poses = [e for e in log.index.chunks if CHANNELS["/tf"] in e.message_index_offsets]
    place = poses[1].chunk_start_offset + poses[1].chunk_length // 2
    found = scan(damaged(log, tmp_path, (place, 8)))
    assert found.groups == [whole[0], *whole[2:]]
    lost = whole[1]
    # Steps are numbered from the state at the start: those before and after it are whole.
    times = f"t = {(lost.first - 1) / 240:.9g} to {(lost.last + 1) / 240:.9g} s"
    (said,) = found.lost
    assert said == f"steps {lost.first} to {lost.last} ({times})"


def test_a_log_that_was_cut_ends_with_its_last_group(log: Logged, tmp_path: Path) -> None:
    whole = scan(log.path).groups
    entry = next(e for e in log.index.chunks if e.message_start_time > whole[1].end)
    found = scan(damaged(log, tmp_path, end=entry.chunk_start_offset + 40))
    assert found.groups == whole[:2]
    assert not found.ended
    assert found.crc is None
    last = whole[1].last
    seconds = last * 10**9 // 240 / 1e9  # a log counts whole ns
    assert found.lost == [f"what followed step {last} (t = {seconds:.9g} s)", "how the run ended"]


def test_descriptions_that_are_gone_are_named(log: Logged, tmp_path: Path) -> None:
    entry = log.index.attachments[1]
    found = scan(damaged(log, tmp_path, (entry.offset + 40, 9)))
    assert found.lost == ["attachment resolved.json"]
    assert len(found.groups) == len(scan(log.path).groups)
    cut = scan(damaged(log, tmp_path, (entry.offset + 40, 9), end=-300))
    assert cut.lost[0] == "attachment resolved.json"


def test_the_geometry_is_missed(log: Logged, tmp_path: Path) -> None:
    entry = log.index.chunks[0]
    found = scan(damaged(log, tmp_path, (entry.chunk_start_offset + 80, 8)))
    assert found.lost == ["the scene's shapes, /robot_description"]


def test_what_stands_before_the_first_record_can_be_made_again(log: Logged, tmp_path: Path) -> None:
    """The magic and the header are the same in every log."""
    assert scan(damaged(log, tmp_path, (0, HEAD))).lost == []


def test_without_a_whole_group_there_is_nothing_to_save(log: Logged, tmp_path: Path) -> None:
    first = log.index.chunks[0].chunk_start_offset
    with pytest.raises(TraceError, match="nothing to save, no group of steps is whole"):
        scan(damaged(log, tmp_path, end=first + 100))


def test_a_stretch_of_which_nothing_is_known_costs_the_group_behind_it(
    log: Logged, tmp_path: Path
) -> None:
    """Without summary, chunk and message indexes: it may have been any chunk of that group."""
    whole = scan(log.path).groups
    poses = [e for e in log.index.chunks if CHANNELS["/tf"] in e.message_index_offsets]
    length = poses[1].chunk_length + poses[1].message_index_length
    found = scan(damaged(log, tmp_path, (poses[1].chunk_start_offset, length), end=-300))
    assert found.groups == [whole[0], *whole[2:]]
