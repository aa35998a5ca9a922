"""A damaged log is refused, or reads as it was; a killed one gives a prefix."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sample import AS_WRITTEN, CONFIG, METADATA, run, split, write

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, Trace, TraceWriter, open_trace, recover
from lavendersim.trace.reader import INCOMPLETE

STEPS = 1000  # three groups


@pytest.fixture(scope="module")
def block() -> Block:
    return run(STEPS, contacts=2)


@pytest.fixture(scope="module")
def whole(block: Block, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return write(tmp_path_factory.mktemp("log") / "run.mcap", [block]).read_bytes()


def content(trace: Trace) -> tuple[object, ...]:
    tables = (trace.step, trace.contact, trace.pose, trace.residual)
    described = (trace.bodies, trace.timestep, trace.metadata, trace.status)
    texts = (trace.as_written, trace.config)
    return (*((t.dtype, t.tobytes()) for t in tables), *described, *texts)


def assert_prefix(trace: Trace, block: Block, steps: int) -> None:
    part = split(block, [steps])[0]
    for table, written in ((trace.step, part.step), (trace.contact, part.contact)):
        for name in written.dtype.names or ():
            assert table[name].tobytes() == written[name].tobytes()
    assert trace.pose.tobytes() == part.pose.tobytes()
    assert trace.residual.tobytes() == part.residual.tobytes()


def test_a_flipped_bit_never_gives_other_data(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "flipped.mcap"
    path.write_bytes(whole)
    truth = content(open_trace(path))
    random = np.random.default_rng(7)
    edges = [*range(0, 80, 2), *range(len(whole) - 400, len(whole), 3)]
    refused = 0
    for position in [*edges, *random.integers(0, len(whole), 150)]:
        flipped = bytearray(whole)
        flipped[position] ^= 1 << int(random.integers(8))
        path.write_bytes(flipped)
        try:
            assert content(open_trace(path)) == truth, position
        except TraceError as error:
            assert str(path) in str(error)  # noqa: PT017 (equal data are as good)
            refused += 1
    assert refused > 100  # most bytes are data, and are checked


def test_a_run_cut_anywhere_recovers_a_prefix(tmp_path: Path, whole: bytes, block: Block) -> None:
    path, out = tmp_path / "cut.mcap", tmp_path / "saved.mcap"
    saved = set()
    for length in [*np.linspace(0, len(whole) - 1, 60).astype(int), len(whole) - 100]:
        path.write_bytes(whole[:length])
        with pytest.raises(TraceError):
            open_trace(path)
        try:
            report = recover(path, out)
        except TraceError as error:
            assert "nothing to save" in str(error)  # noqa: PT017 (early cuts hold no step)
            saved.add(0)
            continue
        trace = open_trace(out, allow_incomplete=True)
        assert trace.status == report.status
        if report.outcome == "whole":  # cut behind all that was recorded
            assert out.read_bytes() == whole
        else:
            assert report.status.startswith("recovered: ")
            assert "what followed step" in report.lost[0] or report.steps == STEPS
            assert not trace.complete
        assert len(trace.step) == report.steps
        assert_prefix(trace, block, report.steps)
        saved.add(report.steps)
        out.unlink()
    assert 0 in saved
    assert STEPS in saved
    assert len(saved) >= 4  # group by group


def test_a_killed_run_is_read_without_being_rewritten(tmp_path: Path, block: Block) -> None:
    path = write(tmp_path / "killed.mcap", split(block, [300, 300]), status=None)
    with pytest.raises(TraceError, match="lavender recover"):
        open_trace(path)
    trace = open_trace(path, allow_incomplete=True)
    assert (trace.status, trace.complete) == (INCOMPLETE, False)
    assert "unfinished" in trace.damage
    assert 0 < len(trace.step) < STEPS
    assert_prefix(trace, block, len(trace.step))


def test_what_closed_is_in_the_file_while_the_run_goes_on(tmp_path: Path, block: Block) -> None:
    """A kill calls nothing: the file is what it was at that moment."""
    path = tmp_path / "running.mcap"
    writer = TraceWriter(path, CONFIG, AS_WRITTEN, METADATA)
    writer.append(block)
    writer._queue.drain()
    found = path.read_bytes()
    writer.abandon()
    assert path.read_bytes() == found
    assert len(open_trace(path, allow_incomplete=True).step) > STEPS // 2


def test_a_log_is_recovered_beside_itself_and_to_no_file_that_exists(
    tmp_path: Path, whole: bytes, block: Block
) -> None:
    path, beside = tmp_path / "cut.mcap", tmp_path / "cut.recovered.mcap"
    path.write_bytes(whole[: len(whole) * 3 // 4])
    report = recover(path)
    assert report.out == beside
    assert_prefix(open_trace(beside, allow_incomplete=True), block, report.steps)
    assert path.read_bytes() == whole[: len(whole) * 3 // 4]
    for out in (beside, path):
        before = out.read_bytes()
        with pytest.raises(UsageError, match="exists already"):
            recover(path, out)
        assert out.read_bytes() == before
    assert sorted(tmp_path.iterdir()) == [path, beside]


def test_what_was_recovered_of_a_log_is_no_whole_one(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: len(whole) * 3 // 4])
    out = recover(path).out
    assert out is not None
    with pytest.raises(TraceError, match="recovered: "):
        open_trace(out)
    again = recover(out)
    assert (again.out, again.outcome) == (None, "part")


def test_a_whole_log_needs_no_recovery(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "run.mcap"
    path.write_bytes(whole)
    report = recover(path, tmp_path / "out.mcap")
    assert (report.out, report.outcome, report.steps, report.lost) == (None, "whole", STEPS, ())
    assert list(tmp_path.iterdir()) == [path]


def test_metadata_are_guarded_though_mcap_does_not(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "run.mcap"
    assert whole.count(b'["floor", "ball", "crate"]') == 1
    path.write_bytes(whole.replace(b'["floor", "ball", "crate"]', b'["floor", "bell", "crate"]'))
    with pytest.raises(TraceError, match="metadata"):
        open_trace(path)
