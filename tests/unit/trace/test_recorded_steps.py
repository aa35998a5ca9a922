"""A log with contacts and poses of some steps has those, and says so where it is asked for all."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sample import AS_WRITTEN, METADATA, SCENE, run, split, without

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, Trace, TraceWriter, open_trace, recover, trace_of
from lavendersim.trace.recorded import is_recorded, recorded_states
from tests.made_cells import made_cell

STEPS = 900  # several groups
NONE = {"residuals": "none", "problems": "none"}
# 240 steps a second: 0.5 s is step 120, 1.25 s step 300. Both ends count.
WINDOW = {"from": 0.5, "to": 1.25}
RECORDS: dict[str, tuple[dict[str, Any], list[int], list[int]]] = {
    "every": (
        {"contacts": "every 4", "poses": "every 7"},
        list(range(0, STEPS, 4)),
        list(range(0, STEPS, 7)),
    ),
    "window": ({"contacts": WINDOW}, list(range(120, 301)), list(range(STEPS))),
    "nothing": ({"poses": {"from": 100.0, "to": 101.0}}, list(range(STEPS)), []),
    "first": ({"contacts": "every 1000", "poses": {"from": 0.0, "to": 0.001}}, [0], [0]),
}


def write(path: Path, record: dict[str, Any], blocks: list[Block], close: bool = True) -> Path:
    writer = TraceWriter(path, made_cell(SCENE, record=NONE | record), AS_WRITTEN, METADATA)
    for block in blocks:
        writer.append(block)
    if close:
        writer.close("complete")
    else:
        writer.abandon()
    return path


def assert_holds(trace: Trace, block: Block, contacts: list[int], poses: list[int]) -> None:
    """Hold what is there against the run, bit for bit."""
    for name in block.step.dtype.names or ():
        assert trace.step[name].tobytes() == block.step[name].tobytes()
    expected = block.contact[np.isin(block.contact["step"], contacts)]
    for name in block.contact.dtype.names or ():
        if len(expected):
            assert trace.recorded_contact[name].tobytes() == expected[name].tobytes(), name
    assert trace.recorded_rows("/contacts").tolist() == contacts
    assert trace.recorded_rows("/tf").tolist() == poses
    assert trace.recorded_pose.rows.tolist() == poses
    assert trace.recorded_pose.pose.tobytes() == block.pose[poses].tobytes()
    assert trace.residual.tobytes() == block.residual.tobytes()


@pytest.mark.parametrize("name", RECORDS)
def test_what_is_recorded_returns_bit_for_bit(tmp_path: Path, name: str) -> None:
    record, contacts, poses = RECORDS[name]
    block = run(STEPS)
    assert_holds(open_trace(write(tmp_path / "run.mcap", record, [block])), block, contacts, poses)


def test_a_log_in_memory_is_the_log_on_disk(tmp_path: Path) -> None:
    record, contacts, poses = RECORDS["every"]
    config = made_cell(SCENE, record=NONE | record)
    writer, block = TraceWriter(tmp_path / "run.mcap", config, AS_WRITTEN, METADATA), run(STEPS)
    writer.append(block)
    assert_holds(trace_of(writer.close("complete")), block, contacts, poses)


@pytest.mark.parametrize("name", RECORDS)
@pytest.mark.parametrize("sizes", [[1] * 40, [100] * 8, [327, 1, 300]])
def test_the_bytes_do_not_depend_on_how_steps_are_split(
    tmp_path: Path, name: str, sizes: list[int]
) -> None:
    block, record = run(STEPS), RECORDS[name][0]
    whole = write(tmp_path / "whole.mcap", record, [block]).read_bytes()
    parts = write(tmp_path / "split.mcap", record, split(block, sizes))
    assert parts.read_bytes() == whole


def test_what_needs_every_step_is_refused_with_the_steps_there_are(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", RECORDS["every"][0], [run(STEPS)]))
    assert trace.metadata["recorded"] == {"contacts": "every 4", "poses": "every 7"}
    says = "this log has not every step of /tf: record.poses is every 7"
    with pytest.raises(UsageError, match=says):
        _ = trace.pose
    says = "this log has not every step of /contacts: record.contacts is every 4"
    with pytest.raises(UsageError, match=says):
        _ = trace.contact["impulse_n"]
    assert len(trace.contact) == 0
    assert list(trace.contacts_in_parts()) == []
    assert {"/tf", "/contacts"} <= trace.absent.keys()
    assert trace.has("/tf")
    assert trace.has("/contacts")


def test_a_stretch_of_time_is_named_as_the_config_has_it(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", RECORDS["window"][0], [run(STEPS)]))
    assert trace.metadata["recorded"] == {"contacts": "from 0.5 to 1.25 s"}
    assert len(trace.pose) == STEPS


def test_a_log_of_every_step_says_nothing_of_it(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", {"poses": "all"}, [run(3)]))
    assert "recorded" not in trace.metadata
    assert trace.absent == {"/velocities": "record.velocities is false"}


def test_a_topic_that_is_absent_is_not_recorded_of_some_steps(tmp_path: Path) -> None:
    absent = {"/contacts": "nothing can touch"}
    config = made_cell(SCENE, record=NONE | {"contacts": "every 4"})
    writer = TraceWriter(tmp_path / "run.mcap", config, AS_WRITTEN, METADATA, absent)
    writer.append(without(run(9), "/contacts"))
    trace = trace_of(writer.close("complete"))
    assert not trace.has("/contacts")
    with pytest.raises(UsageError, match="this log has no /contacts: nothing can touch"):
        _ = trace.recorded_contact["x"]


def test_a_killed_run_gives_a_prefix(tmp_path: Path) -> None:
    record, contacts, poses = RECORDS["every"]
    block = run(STEPS)
    whole = write(tmp_path / "run.mcap", record, [block], close=False).read_bytes()
    saved = set()
    for share in (0.4, 0.6, 0.8, 1.0):
        (tmp_path / "cut.mcap").write_bytes(whole[: int(share * len(whole))])
        try:
            steps = recover(tmp_path / "cut.mcap", tmp_path / "out.mcap").steps
        except TraceError:
            continue
        log = open_trace(tmp_path / "out.mcap", allow_incomplete=True)
        part = split(block, [steps])[0]
        mine = ([step for step in of if step < steps] for of in (contacts, poses))
        assert_holds(log, part, *mine)
        saved.add(steps)
        (tmp_path / "out.mcap").unlink()
    assert saved
    assert max(saved) < STEPS


@pytest.mark.parametrize("name", RECORDS)
def test_as_many_states_are_reckoned_with_as_are_recorded(name: str) -> None:
    config = made_cell(SCENE, record=NONE | RECORDS[name][0])
    for which, states in zip(
        (config.record.contacts, config.record.poses), RECORDS[name][1:], strict=True
    ):
        assert recorded_states(which, config.clock, STEPS - 1) == len(states)
        steps = np.arange(STEPS)
        assert np.flatnonzero(is_recorded(which, config.clock, steps)).tolist() == states


def test_a_stretch_of_time_counts_the_steps_of_every_timestep() -> None:
    """1/100 s until 0.1 s, then 1/1000 s: the states within 0.095 and 0.105 s are 10 to 15."""
    config = made_cell(
        SCENE,
        numerics={"timestep": "1/100"},
        events=[{"at": 0.1, "timestep": "1/1000"}],
        record=NONE | {"poses": {"from": 0.095, "to": 0.105}},
    )
    mask = is_recorded(config.record.poses, config.clock, np.arange(40))
    assert np.flatnonzero(mask).tolist() == [10, 11, 12, 13, 14, 15]
