"""The reader: what a log has, of which steps, and the reason where a column is not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sample import AS_WRITTEN, BODIES, CONFIG, METADATA, SCENE, run, write

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, Trace, TraceWriter, open_trace, reader
from lavendersim.trace.layout import CHANNELS
from lavendersim.trace.schema import FORMER_NOT_REPORTED
from lavendersim.trace.writer import NOT_REPORTED_COLUMNS
from tests.made_cells import made_cell

STEPS = 900
EVERY_THIRD = made_cell(SCENE, record={"residuals": "none", "problems": "none", "contacts": "every 3", "poses": {"from": 1.0, "to": 2.0}})  # noqa: E501  # fmt: skip


@pytest.fixture(scope="module")
def block() -> Block:
    return run(STEPS)


def test_parts_are_the_whole_and_are_not_kept(tmp_path: Path, block: Block) -> None:
    trace = open_trace(write(tmp_path / "a.mcap", [block]))
    parts = list(trace.steps_in_parts())
    assert len(parts) > 1
    assert "step" not in trace.__dict__
    assert np.concatenate(parts).tobytes() == trace.step.tobytes()
    assert [len(part) for part in trace.steps_in_parts()] == [STEPS]  # read already
    contacts = list(trace.contacts_in_parts())
    assert np.concatenate([one["x"] for one in contacts]).tobytes() == block.contact["x"].tobytes()
    steps = np.concatenate([numbers for numbers, _ in trace.poses_in_parts()])
    assert steps.tolist() == block.step["step"].tolist()


def test_contacts_are_kept_for_who_asks_again_unless_they_are_too_many(
    tmp_path: Path, block: Block, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path / "a.mcap", [block])

    def asked_twice(trace: Trace) -> bool:
        first, second = list(trace.contacts_in_parts()), list(trace.contacts_in_parts())
        assert [one.tobytes() for one in first] == [one.tobytes() for one in second]
        return all(map(np.shares_memory, first, second))

    trace = open_trace(path)
    next(trace.contacts_in_parts())  # who stops in between leaves nothing behind
    assert asked_twice(trace)
    assert trace.contact.tobytes() == open_trace(path).contact.tobytes()
    monkeypatch.setattr(reader, "KEPT_BYTES", 1000)
    assert not asked_twice(open_trace(path))


@pytest.mark.parametrize("key", [NOT_REPORTED_COLUMNS, FORMER_NOT_REPORTED])
def test_parts_refuse_columns_that_the_engine_does_not_report(
    key: str, tmp_path: Path, block: Block
) -> None:
    """Logs of this version, and of those before."""
    not_reported = {key: {"/contacts.gamma": "it is a secret"}}
    writer = TraceWriter(tmp_path / "a.mcap", CONFIG, AS_WRITTEN, METADATA | not_reported)
    writer.append(block)
    writer.close("complete")
    trace = open_trace(tmp_path / "a.mcap")
    for _ in range(2):
        part = next(trace.contacts_in_parts())
        assert len(part["x"])
        with pytest.raises(UsageError, match=r"no /contacts\.gamma: it is a secret"):
            part["gamma"]
        assert len(trace.contact)  # afterwards it is in one piece


def test_of_some_steps_alone_rows_are_those_of_the_config(tmp_path: Path, block: Block) -> None:
    """Every third contact; poses from 1 s to 2 s, which at 240 Hz are steps 240 to 480."""
    trace = open_trace(write(tmp_path / "a.mcap", [block], config=EVERY_THIRD))
    rows, pose = trace.recorded_pose
    assert rows.tolist() == list(range(240, 481))
    assert pose.tobytes() == block.pose[240:481].tobytes()
    kept = block.contact[block.contact["step"] % 3 == 0]
    assert trace.recorded_contact["nx"].tobytes() == kept["nx"].tobytes()
    assert trace.has("/contacts")
    with pytest.raises(
        UsageError, match=r"has not every step of /tf: record\.poses is from 1 to 2 s"
    ):
        trace.pose  # noqa: B018
    assert len(trace.contact) == 0
    with pytest.raises(UsageError, match=r"record\.contacts is every 3"):
        trace.contact["x"]
    assert list(trace.contacts_in_parts()) == []


def test_a_topic_that_is_absent_has_its_reason(tmp_path: Path, block: Block) -> None:
    empty = block._replace(contact=block.contact[:0], residual=block.residual[:0])
    why = {"/contacts": "nothing can touch", "/residuals": "nobody asked", "/tf": "to be short"}
    trace = open_trace(write(tmp_path / "a.mcap", [empty], absent=why))
    said = "this log has no /contacts: nothing can touch"
    assert trace.why_not("/contacts") == f"{trace.path}: {said}"
    assert not trace.has("/contacts")
    for read in (
        lambda: trace.pose,
        lambda: trace.recorded_pose,
        lambda: next(trace.poses_in_parts()),
        lambda: trace.residual["residual"],
        lambda: trace.contact["x"],
        lambda: next(trace.recorded_contacts_in_parts()),
        lambda: trace.velocity,
        lambda: trace.table("pose"),
    ):
        with pytest.raises(UsageError, match="this log has no /"):
            read()


def test_velocities_are_there_where_the_config_records_them(tmp_path: Path) -> None:
    record = {"residuals": "none", "problems": "none", "velocities": True}
    block = run(30)
    speeds = np.random.default_rng(3).normal(size=(30, len(BODIES), 6))
    wide = block._replace(pose=np.concatenate([block.pose, speeds], axis=2))
    trace = open_trace(write(tmp_path / "a.mcap", [wide], config=made_cell(SCENE, record=record)))
    assert trace.velocity.tobytes() == speeds.tobytes()
    assert trace.pose.tobytes() == block.pose.tobytes()
    plain = open_trace(write(tmp_path / "b.mcap", [block]))
    with pytest.raises(UsageError, match=r"record\.velocities is false"):
        plain.velocity  # noqa: B018


def test_a_run_that_ended_before_its_first_step_has_no_rows(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "a.mcap", [], status="diverged"))
    assert (len(trace.step), len(trace.residual), trace.status) == (0, 0, "diverged")
    assert "time" in (trace.step.dtype.names or ())
    assert trace.pose.shape == (0, len(BODIES), 7)
    assert not trace.complete


def test_another_format_is_refused_by_its_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: Block
) -> None:
    monkeypatch.setattr("lavendersim.trace.writer.FORMAT", "2")
    path = write(tmp_path / "a.mcap", [run(3)])
    with pytest.raises(TraceError, match="log format 2, this version reads 1"):
        open_trace(path)
    assert len(set(CHANNELS.values())) == len(CHANNELS)
