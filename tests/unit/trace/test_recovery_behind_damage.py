"""Recovery goes on behind damage, says what it costs, and needs no more memory for a longer log."""

from __future__ import annotations

import gc
import tracemalloc
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from mcap.records import ChunkIndex
from sample import run, write

from lavendersim.trace import Trace, chunk_queue, open_trace, recover
from lavendersim.trace.contact_rows import COLUMNS, POINTS, contact_rows
from lavendersim.trace.index import read_chunk, read_summary
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.recovery import EXCHANGED, RecoveryReport
from lavendersim.trace.writer import description_of

STEPS = 901  # six groups
GROUPS = 6
STEP = CHANNELS["/step"]


class Log(NamedTuple):
    """A whole log: its bytes, what reads it, and where its chunks stand."""

    data: bytes
    trace: Trace
    chunks: list[ChunkIndex]

    def lights(self) -> list[ChunkIndex]:
        """Return the last chunk of every group."""
        return [entry for entry in self.chunks if STEP in entry.message_index_offsets]

    def first(self) -> int:
        """Return how many steps the first group has."""
        times = self.trace.step["time_ns"]
        return int(np.searchsorted(times, self.lights()[1].message_start_time))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Log:
    path = write(tmp_path_factory.mktemp("log") / "run.mcap", [run(STEPS, contacts=2)])
    log = Log(path.read_bytes(), open_trace(path), read_summary(path).chunks)
    assert len(log.lights()) == GROUPS
    return log


def recovered(data: bytes, folder: Path) -> tuple[RecoveryReport, Trace]:
    """Recover damaged bytes and open what was saved."""
    path = folder / "damaged.mcap"
    path.write_bytes(data)
    report = recover(path, folder / "saved.mcap")
    assert report.out is not None
    return report, open_trace(report.out, allow_incomplete=True)


def flipped(data: bytes, position: int, bit: int = 0) -> bytes:
    changed = bytearray(data)
    changed[position] ^= 1 << bit
    return bytes(changed)


def assert_part(trace: Trace, whole: Trace) -> None:
    """Of the steps that are there everything is, to the bit."""
    steps = trace.step["step"]
    assert trace.step.tobytes() == whole.step[steps].tobytes()
    assert trace.pose.tobytes() == whole.pose[steps].tobytes()
    for name in ("contact", "residual"):
        rows = getattr(whole, name)
        kept: Any = rows[np.isin(rows["step"], steps)]
        assert getattr(trace, name).tobytes() == kept.tobytes()


def test_a_bit_eight_percent_into_a_log_costs_one_group(whole: Log, tmp_path: Path) -> None:
    report, trace = recovered(flipped(whole.data, len(whole.data) * 8 // 100), tmp_path)
    assert report.outcome == "part"
    first = whole.first()
    assert (len(report.lost), report.lost[0].partition(" (")[0]) == (1, f"steps 0 to {first - 1}")
    assert report.steps == len(trace.step) == STEPS - first
    assert_part(trace, whole.trace)
    assert report.status == (
        f"recovered: {STEPS - first} steps, up to {(STEPS - 1) / 240:g} s; lost: {report.lost[0]}"
    )
    assert trace.status == report.status
    assert trace.config == whole.trace.config


@pytest.mark.parametrize("place", ["opcode", "length", "times", "payload"])
@pytest.mark.parametrize("with_summary", [True, False], ids=["closed", "cut"])
def test_a_damaged_chunk_costs_its_group(
    whole: Log, place: str, with_summary: bool, tmp_path: Path
) -> None:
    offset = {"opcode": 0, "length": 3, "times": 12, "payload": 80}[place]
    entry = whole.lights()[2]
    data = flipped(whole.data, entry.chunk_start_offset + offset)
    report, trace = recovered(data if with_summary else data[:-300], tmp_path)
    assert_part(trace, whole.trace)
    groups = GROUPS - len({group for group in report.lost if group.startswith("steps")})
    # Times are made again; without a summary its message index says what it was.
    assert groups == (GROUPS if place == "times" else GROUPS - 1)


def test_what_surrounds_the_numbers_is_made_again(whole: Log, tmp_path: Path) -> None:
    """Header, message index, a chunk's times, summary, footer, magic: nothing is lost."""
    chunk = whole.chunks[6]
    behind = chunk.chunk_start_offset + chunk.chunk_length
    for number, position in enumerate(
        (0, 20, chunk.chunk_start_offset + 12, behind, behind + 12, len(whole.data) - 400, -20, -1)
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        report, trace = recovered(flipped(whole.data, position), folder)
        assert (report.outcome, report.lost, report.status) == ("whole", (), "complete"), position
        assert trace.path.read_bytes() == whole.data


def test_a_lost_attachment_or_description_is_reported_and_the_numbers_stay(
    whole: Log, tmp_path: Path
) -> None:
    for number, (word, lost) in enumerate(
        (
            (b"question: does it bounce?", "attachment config.yaml"),
            (b'"slop"', "attachment resolved.json"),
            (b'["floor", "ball", "crate"]', "metadata 'trace'"),
            (b"digest", "metadata 'plan'"),
        )
    ):
        for data in (whole.data, whole.data[:-300]):
            folder = tmp_path / f"{number}{len(data)}"
            folder.mkdir()
            report, trace = recovered(flipped(data, data.index(word) + 2), folder)
            assert report.steps == STEPS
            if number < 3 or len(data) == len(whole.data):
                assert report.lost == (lost,)
            else:  # without a summary nobody knows its name
                assert "before the first step" in report.lost[0]
            assert_part(trace, whole.trace)


def test_the_description_that_is_made_again_is_that_of_the_writer(whole: Log) -> None:
    written = dict(whole.trace.metadata["trace"])
    assert description_of(whole.trace.config, {}) == written


def test_the_first_group_has_the_schemas_and_the_log_is_read_without_it(
    whole: Log, tmp_path: Path
) -> None:
    """They are taken from the summary, and stand before the first message of the new log."""
    data = whole.data
    for entry in whole.chunks[:5]:
        data = flipped(data, entry.chunk_start_offset + 80)
    report, trace = recovered(data, tmp_path)
    assert report.steps == STEPS - whole.first()
    assert "/robot_description" in report.lost[0]
    assert_part(trace, whole.trace)
    assert report.out is not None
    from mcap.reader import NonSeekingReader

    with report.out.open("rb") as stream:
        topics = {channel.topic for _, channel, _ in NonSeekingReader(stream).iter_messages()}
    assert {"/step", "/tf", "/contacts", "/contact_columns", "/residuals"} <= topics


def test_groups_in_the_wrong_place_are_none(whole: Log, tmp_path: Path) -> None:
    poses = [e for e in whole.chunks if CHANNELS["/tf"] in e.message_index_offsets]
    places = [
        slice(e.chunk_start_offset, e.chunk_start_offset + e.chunk_length)
        for e in (poses[1], poses[3])
    ]
    one, two = (whole.data[place] for place in places)
    first, second = places
    data = whole.data[: first.start] + two + whole.data[first.stop : second.start] + one
    report, trace = recovered(data + whole.data[second.stop :], tmp_path)
    assert report.steps < STEPS
    assert_part(trace, whole.trace)


def test_a_chunk_of_another_log_is_not_taken_for_certain(whole: Log, tmp_path: Path) -> None:
    """Its steps and its CRC are right; only the CRC over all records says that it is another's."""
    block = run(STEPS, contacts=2)
    other = write(tmp_path / "other.mcap", [block._replace(pose=block.pose + 1.0)])
    theirs = [e for e in read_summary(other).chunks if CHANNELS["/tf"] in e.message_index_offsets]
    mine = [e for e in whole.chunks if CHANNELS["/tf"] in e.message_index_offsets]
    begin, end = mine[2].chunk_start_offset, mine[2].chunk_start_offset + mine[2].chunk_length
    chunk = other.read_bytes()[theirs[2].chunk_start_offset :][: theirs[2].chunk_length]
    report, trace = recovered(whole.data[:begin] + chunk + whole.data[end:], tmp_path)
    assert (report.outcome, report.lost) == ("part", (EXCHANGED,))
    assert trace.damage


def test_points_and_columns_of_a_chunk_have_as_many_contacts(whole: Log) -> None:
    path = whole.trace.path
    index = read_summary(path)
    counts = {POINTS: 0, COLUMNS: 0}
    with path.open("rb") as stream:
        for entry in index.chunks:
            for channel in counts.keys() & entry.message_index_offsets.keys():
                schema = index.schemas[index.channels[channel].schema_id]
                counts[channel] += contact_rows(read_chunk(stream, entry), channel, schema)
    assert set(counts.values()) == {len(whole.trace.contact)}


def test_memory_does_not_grow_with_the_log(
    whole: Log, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the index of chunks takes aside, a hundredth of the log's bytes (measured: 0.012).

    The bound is a tenth of what the log grows by, 2.6 MB: chunks and parts of the digest that wait
    for a thread count, too, up to 1.5 MB by how the machine schedules threads.
    """
    monkeypatch.setattr(chunk_queue, "MOST_WAITING", 0)  # 64 MB elsewhere
    peaks, sizes = [], []
    for groups in (10, 80):
        path = write(tmp_path / f"{groups}.mcap", [run(whole.first() * groups, contacts=8)])
        path.write_bytes(flipped(path.read_bytes(), 200_000))
        recover(path).out.unlink()  # type: ignore[union-attr]  # imports, caches
        gc.collect()  # so that it is soon looked for again, and none of this piles up
        tracemalloc.start()
        recover(path)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        sizes.append(path.stat().st_size)
    assert peaks[1] - peaks[0] < 0.1 * (sizes[1] - sizes[0])
