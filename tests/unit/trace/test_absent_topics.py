"""A log has the topics that its plan requires and no others, and says why one is not there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from sample import run, split, without, write

from lavendersim.errors import TraceError, UsageError
from lavendersim.trace import Block, open_trace, recover
from lavendersim.trace.container import Container

STEPS = 900  # several groups of steps
TOUCH = "nothing can touch (plan: contact_log off)"
ASKED = "record.residuals is none (plan: residual_log off)"
PLOTS = ("/plot/force", "/plot/penetration", "/plot/log10_residual")
CONTACTS = dict.fromkeys(("/contacts", "/contact_columns", *PLOTS), TOUCH)
RESIDUALS = {"/residuals": ASKED}
SLOW = {"/velocities": "record.velocities is false"}  # of a log whose config says nothing of them
POSES = {"/robot_description": "?", "/tf": "?"}
ALWAYS = {"/robot_description", "/tf", "/step"}


def topics_in(path: Path) -> dict[str, int]:
    """Messages by registered topic, as the mcap package counts them."""
    with path.open("rb") as stream:
        summary = make_reader(stream, validate_crcs=True).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    counts = summary.statistics.channel_message_counts
    assert {channel.schema_id for channel in summary.channels.values()} == set(summary.schemas)
    return {channel.topic: counts.get(number, 0) for number, channel in summary.channels.items()}


@pytest.fixture(scope="module")
def block() -> Block:
    return run(STEPS)


@pytest.fixture
def free(block: Block, tmp_path: Path) -> Path:
    """The log of a scene in which nothing can touch."""
    absent = CONTACTS | RESIDUALS
    return write(tmp_path / "free.mcap", [without(block, *absent)], absent=absent)


def test_where_nothing_can_touch_a_log_holds_geometry_poses_and_steps_alone(free: Path) -> None:
    assert topics_in(free) == {"/robot_description": 1, "/tf": STEPS, "/step": STEPS}


def test_whoever_says_nothing_gets_every_topic(block: Block, tmp_path: Path) -> None:
    found = topics_in(write(tmp_path / "run.mcap", [block]))
    asked = len(np.unique(block.residual["step"]))
    groups = found["/contact_columns"]  # one message of many steps in each
    assert 1 <= groups < STEPS / 100
    assert found == dict.fromkeys([*ALWAYS, *CONTACTS], STEPS) | {
        "/robot_description": 1,
        "/residuals": asked,
        "/contact_columns": groups,
    }
    trace = open_trace(tmp_path / "run.mcap")
    assert trace.absent == SLOW


def test_residuals_go_without_contacts_going(block: Block, tmp_path: Path) -> None:
    path = write(tmp_path / "run.mcap", [without(block, *RESIDUALS)], absent=RESIDUALS)
    assert set(topics_in(path)) == ALWAYS | set(CONTACTS)
    assert open_trace(path).contact["x"].tobytes() == block.contact["x"].tobytes()


def test_what_is_there_reads_as_it_was_written(block: Block, free: Path) -> None:
    trace = open_trace(free)
    for name in block.step.dtype.names or ():
        assert trace.step[name].tobytes() == block.step[name].tobytes()
    assert trace.pose.tobytes() == block.pose.tobytes()
    assert trace.absent == CONTACTS | RESIDUALS | SLOW


@pytest.mark.parametrize("cut", [lambda t: t, lambda t: t[:0], lambda t: t[np.zeros(0, bool)]])
def test_an_absent_table_is_empty_and_says_why_when_asked_for_a_column(free: Path, cut) -> None:
    trace = open_trace(free)
    for table, topic, why in (
        (trace.contact, "/contacts", TOUCH),
        (trace.residual, "/residuals", ASKED),
    ):
        assert len(table) == 0
        for columns in ("step", "impulse_n", ["step", "x"]):
            with pytest.raises(UsageError) as caught:
                cut(table)[columns]
            assert str(caught.value) == f"{free}: this log has no {topic}: {why}"


def test_a_log_that_never_began_knows_what_it_does_without(tmp_path: Path) -> None:
    trace = open_trace(write(tmp_path / "run.mcap", [], "diverged: at once", CONTACTS))
    assert len(trace.contact) == len(trace.step) == 0
    with pytest.raises(UsageError, match="no /contacts: nothing can touch"):
        trace.contact["x"]


def test_without_poses_contacts_stay(block: Block, tmp_path: Path) -> None:
    path = write(tmp_path / "run.mcap", [block], absent=POSES)
    assert set(topics_in(path)) == {"/contacts", "/step", "/residuals", *CONTACTS}
    trace = open_trace(path)
    assert trace.contact["x"].tobytes() == block.contact["x"].tobytes()
    with pytest.raises(UsageError, match="this log has no /tf"):
        _ = trace.pose


def test_steps_alone_make_a_log_and_recover(block: Block, tmp_path: Path) -> None:
    absent = POSES | CONTACTS | RESIDUALS
    path = write(tmp_path / "run.mcap", split(without(block, *absent), [300]), None, absent)
    out = tmp_path / "out.mcap"
    assert 0 < recover(path, out).steps < STEPS
    assert set(topics_in(out)) == {"/step"}


def test_a_killed_log_without_contacts_recovers_up_to_its_last_group(
    block: Block, tmp_path: Path
) -> None:
    absent = CONTACTS | RESIDUALS
    path = write(tmp_path / "run.mcap", [without(block, *absent)], None, absent)
    report = recover(path, tmp_path / "out.mcap")
    trace = open_trace(tmp_path / "out.mcap", allow_incomplete=True)
    assert 0 < report.steps < STEPS
    assert np.array_equal(trace.step["step"], np.arange(report.steps))
    assert trace.pose.tobytes() == block.pose[: report.steps].tobytes()
    assert trace.absent == absent | SLOW
    assert open_trace(path, allow_incomplete=True).pose.tobytes() == trace.pose.tobytes()
    assert recover(tmp_path / "out.mcap", tmp_path / "again.mcap").out is None


def test_a_log_of_less_cut_anywhere_recovers_a_prefix_or_nothing(block: Block, free: Path) -> None:
    whole = free.read_bytes()
    saved = set()
    for length in np.linspace(0, len(whole) - 1, 20).astype(int):
        free.write_bytes(whole[:length])
        try:
            report = recover(free, free.with_name("out.mcap"))
        except TraceError as error:
            assert "nothing to save" in str(error)  # noqa: PT017 (early cuts hold no step)
            saved.add(0)
            continue
        assert report.out is not None
        trace = open_trace(report.out, allow_incomplete=True)
        assert trace.pose.tobytes() == block.pose[: report.steps].tobytes()
        report.out.unlink()
        saved.add(report.steps)
    assert {0, STEPS} < saved  # and some groups between


@pytest.mark.parametrize("sizes", [[1] * 40, [327, 1, 300]])
def test_the_bytes_of_less_do_not_depend_on_how_steps_are_split(
    block: Block, free: Path, sizes: list[int]
) -> None:
    absent = CONTACTS | RESIDUALS
    parts = split(without(block, *absent), sizes)
    assert write(free.with_name("split.mcap"), parts, absent=absent).read_bytes() == (
        free.read_bytes()
    )


@pytest.mark.parametrize("absent", [CONTACTS, RESIDUALS])
def test_rows_of_a_topic_that_the_log_does_without_are_refused(
    block: Block, tmp_path: Path, absent: dict[str, str]
) -> None:
    with pytest.raises(ValueError, match=f"has rows for {next(iter(absent))}"):
        write(tmp_path / "run.mcap", [block], absent=absent)


def test_a_log_without_steps_or_of_a_misspelt_topic_is_refused(
    block: Block, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match="without /step"):
        write(tmp_path / "run.mcap", [block], absent={"/step": "?"})
    with pytest.raises(ValueError, match="/contact'"):
        write(tmp_path / "other.mcap", [block], absent={"/contact": "?"})


def test_a_log_from_before_there_was_a_choice_has_every_topic(
    block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = Container.describe

    def as_before(self: Container, name: str, values: Mapping[str, str]) -> None:
        real(self, name, {key: value for key, value in values.items() if key != "absent"})

    monkeypatch.setattr(Container, "describe", as_before)
    trace = open_trace(write(tmp_path / "run.mcap", [block]))
    assert "absent" not in trace.metadata["trace"]
    assert trace.absent == SLOW
    assert trace.contact["x"].tobytes() == block.contact["x"].tobytes()
    assert trace.residual["residual"].tobytes() == block.residual["residual"].tobytes()
