"""A log that was just written: the columns of its file to the bit, of blocks or of the file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sample import AS_WRITTEN, BODIES, METADATA, SCENE, moving, run, split, without

from lavendersim.cell import CellConfig
from lavendersim.errors import NOT_REPORTED, NotReportedError, UsageError
from lavendersim.record_tables import widened, with_room
from lavendersim.trace import Block, TraceWriter, open_trace
from lavendersim.trace.reader import Trace
from lavendersim.trace.writer import NOT_REPORTED_COLUMNS
from lavendersim.trace.written_trace import WrittenTrace, trace_of
from tests.made_cells import made_cell

RECORD = {"residuals": "none", "problems": "none"}


def both(path: Path, blocks: list[Block], absent: Any = None, **record: Any) -> tuple[Trace, Trace]:
    config: CellConfig = made_cell(SCENE, record={**RECORD, **record})
    writer = TraceWriter(path, config, AS_WRITTEN, METADATA, absent)
    for block in blocks:
        writer.append(block)
    return trace_of(writer.close("complete")), open_trace(path)


def same(one: Any, other: Any) -> bool:
    names = other.dtype.names or ()
    if set(names) != set(one.dtype.names or ()) or len(one) != len(other):
        return False
    if not names:
        return one.shape == other.shape and one.tobytes() == other.tobytes()
    return all(one[name].tobytes() == other[name].tobytes() for name in names)


@pytest.mark.parametrize(
    "record",
    [{}, {"contacts": "every 7"}, {"contacts": {"from": 0.1, "to": 0.2}, "poses": "every 2"}],
)
def test_memory_and_file_are_the_same_log(tmp_path: Path, record: dict[str, Any]) -> None:
    blocks = split(moving(200), [1, 60, 99])
    memory, file = both(tmp_path / "a.mcap", blocks, **record)
    assert isinstance(memory, WrittenTrace)
    assert same(memory.step, file.step)
    assert same(memory.residual, file.residual)
    assert same(memory.recorded_contact, file.recorded_contact)
    assert np.array_equal(memory.recorded_pose.rows, file.recorded_pose.rows)
    assert same(memory.recorded_pose.pose, file.recorded_pose.pose)
    parts = list(memory.recorded_contacts_in_parts())
    joined = np.concatenate([part["x"] for part in parts])
    assert joined.tobytes() == file.recorded_contact["x"].tobytes()
    assert (memory.status, memory.config, memory.as_written) == (
        "complete",
        file.config,
        AS_WRITTEN,
    )


def test_rows_with_room_for_their_time_are_not_copied(tmp_path: Path) -> None:
    """The log has the same bytes, each part is the memory of its block, and the time is right."""
    blocks = split(moving(200), [1, 60, 99])
    roomy = [
        one._replace(contact=widened(one.contact, with_room(one.contact.dtype))) for one in blocks
    ]
    plain, _ = both(tmp_path / "a.mcap", blocks)
    memory, file = both(tmp_path / "b.mcap", roomy)
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()
    parts = list(memory.contacts_in_parts())
    assert all(np.shares_memory(*pair) for pair in zip(parts, [b.contact for b in roomy]))  # noqa: B905
    assert len(parts) == len(blocks)
    assert same(np.concatenate([part["time"] for part in parts]), file.contact["time"])
    assert same(memory.contact, file.contact)
    assert same(memory.contact, plain.contact)
    nanoseconds = memory.contact["step"] * 10**9 // 240
    assert memory.contact["time"].tolist() == (nanoseconds / 1e9).tolist()


def test_velocities_are_behind_the_poses(tmp_path: Path) -> None:
    block = run(20)
    speeds = np.random.default_rng(0).normal(size=(20, len(BODIES), 6))
    wide = block._replace(pose=np.concatenate([block.pose, speeds], axis=2))
    memory, file = both(tmp_path / "a.mcap", split(wide, [7]), velocities=True)
    assert same(memory.velocity, file.velocity)
    assert same(memory.velocity, speeds)
    assert same(memory.pose, block.pose)


def test_what_a_log_does_without_is_refused_in_the_same_words(tmp_path: Path) -> None:
    absent = {"/contacts": "nothing can touch", "/residuals": "nobody asked", "/tf": "to be short"}
    block = without(run(20), "/contacts", "/residuals")
    logs = both(tmp_path / "a.mcap", [block], absent)
    for read in (
        lambda one: one.contact["x"],
        lambda one: one.residual["residual"],
        lambda one: one.recorded_pose,
        lambda one: one.velocity,
        lambda one: list(one.recorded_contacts_in_parts()),
    ):
        said = []
        for log in logs:
            with pytest.raises(UsageError) as refused:
                read(log)
            said.append(str(refused.value))
        assert said[0] == said[1]


def test_a_log_without_blocks_is_read_from_its_file(tmp_path: Path) -> None:
    memory, file = both(tmp_path / "a.mcap", [])
    assert not isinstance(memory, WrittenTrace)
    assert len(memory.step) == len(file.step) == 0


def test_a_column_that_an_engine_does_not_report_has_its_reason_in_memory_and_file(
    tmp_path: Path,
) -> None:
    """A measure of a run that has just ended is taken from memory, one of `judge` from the file."""
    whole = moving(20)
    names = [name for name in whole.step.dtype.names or () if name != "residual"]
    kinds = [(name, whole.step.dtype[name]) for name in names]
    block = whole._replace(step=np.array(whole.step[names].tolist(), kinds))
    not_reported = {NOT_REPORTED_COLUMNS: {"/step.residual": f"Engine {NOT_REPORTED}"}}
    config = made_cell(SCENE, record=RECORD)
    writer = TraceWriter(tmp_path / "a.mcap", config, AS_WRITTEN, METADATA | not_reported, None)
    writer.append(block)
    for log in (trace_of(writer.close("complete")), open_trace(tmp_path / "a.mcap")):
        assert log.step["kinetic_energy"].shape == (20,)
        with pytest.raises(
            NotReportedError, match=r"no /step\.residual: Engine does not report it"
        ):
            log.step["residual"]
