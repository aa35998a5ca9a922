"""A damaged log is refused, or reads as it was; a killed one gives a prefix."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sample import run, split, write

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, Trace, open_trace, recover
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


def test_a_flipped_bit_in_a_killed_run_gives_a_prefix(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "killed.mcap"
    path.write_bytes(whole)
    truth = open_trace(path)
    content(truth)  # read now, the file changes below
    killed = whole[: int(len(whole) * 0.9)]
    random = np.random.default_rng(8)
    for position in [*range(8, 1200, 40), *random.integers(0, len(killed), 40)]:
        flipped = bytearray(killed)
        flipped[position] ^= 1 << int(random.integers(8))
        path.write_bytes(flipped)
        try:
            trace = open_trace(path, allow_incomplete=True)
        except TraceError:
            continue
        rows, steps = len(trace.step), trace.step["step"]
        assert trace.step.tobytes() == truth.step[:rows].tobytes()
        assert trace.pose.tobytes() == truth.pose[:rows].tobytes()
        expected = truth.contact[np.isin(truth.contact["step"], steps)]
        assert trace.contact.tobytes() == expected.tobytes()
        assert trace.config == truth.config
        described = {k: v for k, v in truth.metadata.items() if k != "lavender"}
        assert trace.metadata == described


def test_a_run_cut_anywhere_recovers_a_prefix(tmp_path: Path, whole: bytes, block: Block) -> None:
    path, out = tmp_path / "cut.mcap", tmp_path / "saved.mcap"
    saved = set()
    for length in np.linspace(0, len(whole) - 1, 60).astype(int):
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
        assert report.status.startswith("recovered: ")
        assert not trace.complete
        assert report.saved + report.lost == length
        assert len(trace.step) == report.steps
        assert_prefix(trace, block, report.steps)
        saved.add(report.steps)
    assert 0 in saved
    assert STEPS in saved
    assert len(saved) >= 4  # group by group


def test_a_killed_run_is_read_without_being_rewritten(tmp_path: Path, block: Block) -> None:
    path = write(tmp_path / "killed.mcap", split(block, [300, 300]), status=None)
    with pytest.raises(TraceError, match="lavender recover"):
        open_trace(path)
    trace = open_trace(path, allow_incomplete=True)
    assert (trace.status, trace.complete) == (INCOMPLETE, False)
    assert 0 < len(trace.step) < STEPS
    assert_prefix(trace, block, len(trace.step))


def test_a_log_can_be_recovered_in_its_place(tmp_path: Path, whole: bytes, block: Block) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: len(whole) * 3 // 4])
    report = recover(path, path)
    assert_prefix(open_trace(path, allow_incomplete=True), block, report.steps)
    assert list(tmp_path.iterdir()) == [path]


def test_a_whole_log_needs_no_recovery(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "run.mcap"
    path.write_bytes(whole)
    with pytest.raises(UsageError, match="this log is whole"):
        recover(path, tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()


def test_metadata_are_guarded_though_mcap_does_not(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "run.mcap"
    assert whole.count(b'["floor", "ball", "crate"]') == 1
    path.write_bytes(whole.replace(b'["floor", "ball", "crate"]', b'["floor", "bell", "crate"]'))
    with pytest.raises(TraceError, match="metadata"):
        open_trace(path)
