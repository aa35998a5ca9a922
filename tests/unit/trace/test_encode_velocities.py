"""Velocities of a log: every bit of them, beside the poses of their steps; none where not asked."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from sample import CONFIG, run, split, write

from lavendersim.cell import CellConfig
from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, TraceWriter, open_trace, recover, trace_of

STEPS = 900  # several groups of steps


def recording(**record: object) -> CellConfig:
    return CONFIG.model_copy(update={"record": CONFIG.record.model_copy(update=record)})


VELOCITIES = recording(velocities=True)


@pytest.fixture(scope="module")
def block() -> Block:
    """A run whose rows of poses go on with velocities of any bits."""
    one, more = run(STEPS), run(STEPS, seed=7)
    return one._replace(pose=np.concatenate([one.pose, more.pose[:, :, :6]], axis=2))


@pytest.mark.parametrize("sizes", [[], [1, 200, 3]])
def test_poses_and_velocities_come_back_bit_for_bit(
    block: Block, sizes: list[int], tmp_path: Path
) -> None:
    path = write(tmp_path / "run.mcap", split(block, sizes), config=VELOCITIES)
    trace = open_trace(path)
    assert trace.pose.tobytes() == np.ascontiguousarray(block.pose[:, :, :7]).tobytes()
    assert trace.velocity.tobytes() == np.ascontiguousarray(block.pose[:, :, 7:]).tobytes()
    assert sum(len(steps) for steps, _ in trace.velocities_in_parts()) == STEPS


def test_who_has_just_written_a_log_reads_the_same(block: Block, tmp_path: Path) -> None:
    writer = TraceWriter(tmp_path / "run.mcap", VELOCITIES, "", {})
    writer.append(block)
    at_hand = trace_of(writer.close("complete"))
    from_file = open_trace(tmp_path / "run.mcap")
    assert at_hand.pose.tobytes() == from_file.pose.tobytes()
    assert at_hand.velocity.tobytes() == from_file.velocity.tobytes()


def test_velocities_that_rows_have_unasked_are_written(block: Block, tmp_path: Path) -> None:
    # `effects: {velocity_log: on}` without `record.velocities`
    writer = TraceWriter(tmp_path / "run.mcap", CONFIG, "", {})
    writer.append(block)
    assert trace_of(writer.close("complete")).velocity.tobytes() == block.pose[:, :, 7:].tobytes()
    trace = open_trace(tmp_path / "run.mcap")
    assert trace.pose.tobytes() == np.ascontiguousarray(block.pose[:, :, :7]).tobytes()
    assert trace.velocity.tobytes() == np.ascontiguousarray(block.pose[:, :, 7:]).tobytes()


def test_a_table_has_a_row_for_every_body(block: Block, tmp_path: Path) -> None:
    path = write(tmp_path / "run.mcap", [block], config=VELOCITIES)
    table = pa.table(open_trace(path).table("velocity"))
    assert table.num_rows == STEPS * 3
    assert table["wz"].to_numpy().tobytes() == block.pose[:, :, 12].tobytes()


def test_a_log_without_them_says_why(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", [run(5)]))
    assert not trace.has("/velocities")
    with pytest.raises(UsageError, match=r"this log has no /velocities: record.velocities is fal"):
        _ = trace.velocity
    with pytest.raises(UsageError, match="this log has no /velocities"):
        trace.table("velocity")


def test_velocities_are_of_the_steps_whose_poses_are(block: Block, tmp_path: Path) -> None:
    config = recording(velocities=True, poses="every 7")
    trace = open_trace(write(tmp_path / "run.mcap", [block], config=config))
    parts = list(trace.velocities_in_parts())
    assert np.concatenate([steps for steps, _ in parts]).tolist() == list(range(0, STEPS, 7))
    found = np.concatenate([velocities for _, velocities in parts])
    assert found.tobytes() == np.ascontiguousarray(block.pose[::7, :, 7:]).tobytes()
    with pytest.raises(UsageError, match="has not every step of /tf"):
        _ = trace.velocity


def test_a_block_without_them_is_refused(tmp_path: Path) -> None:
    writer = TraceWriter(tmp_path / "run.mcap", VELOCITIES, "", {})
    with pytest.raises(ValueError, match="poses have shape"):
        writer.append(run(5))
    writer.abandon()


def test_a_cut_log_gives_back_the_velocities_of_whole_groups(block: Block, tmp_path: Path) -> None:
    path = write(tmp_path / "run.mcap", [block], config=VELOCITIES)
    data = path.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: len(data) * 2 // 3])
    with pytest.raises(TraceError):
        open_trace(cut)
    report = recover(cut, tmp_path / "whole.mcap")
    assert 0 < report.steps < STEPS
    trace = open_trace(tmp_path / "whole.mcap", allow_incomplete=True)
    expected = np.ascontiguousarray(block.pose[: report.steps, :, 7:])
    assert trace.velocity.tobytes() == expected.tobytes()


def test_rerun_checks_a_log_with_velocities_without_an_issue(block: Block, tmp_path: Path) -> None:
    path = write(tmp_path / "run.mcap", [block], config=VELOCITIES)
    command = [sys.executable, "-m", "rerun", "mcap", "check", "--full", str(path)]
    report = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout
    listed = re.findall(r"^(\w+) +\d+ +\d+ +(/\S+) +(.+)$", report, re.M)
    assert "/velocities" in {topic for _, topic, _ in listed}
    assert {(status, issue.strip()) for status, _, issue in listed} == {("ok", "—")}
