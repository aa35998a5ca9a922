"""A run's log has the topics of its plan's effects, its reasons are the plan's, and equal bytes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

import lavendersim
from lavendersim.engine.effects import EFFECTS
from lavendersim.errors import UsageError
from lavendersim.experiment import load_experiment_text
from lavendersim.trace.layout import CHANNELS

FREE = """\
scene:
  gravity: 0
  bodies:
    top:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      position: [0, 0, 0]
      velocity: [0, 0, 1]
numerics: chapter
duration: 0.5
"""
FLOOR = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 5]}
numerics: chapter
duration: 0.5
"""
ASKED = "record: {residuals: {from: 0.1, to: 0.2}}\n"
TOUCHING = {
    "/contacts",
    "/contact_columns",
    "/plot/force",
    "/plot/penetration",
    "/plot/log10_residual",
}
ALWAYS = {"/robot_description", "/tf", "/step"}


def log_of(text: str, root: Path) -> Path:
    finished = lavendersim.run(load_experiment_text(text, "scene.yaml"), root=root)
    return finished.run.cells[0].path


def messages(path: Path) -> dict[str, int]:
    with path.open("rb") as stream:
        summary = make_reader(stream, validate_crcs=True).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    counts = summary.statistics.channel_message_counts
    return {channel.topic: counts.get(number, 0) for number, channel in summary.channels.items()}


def test_the_log_of_a_free_body_holds_its_geometry_its_poses_and_its_steps(tmp_path: Path) -> None:
    path = log_of(FREE, tmp_path)
    states = len(lavendersim.open_trace(path).step)
    assert states > 1
    assert messages(path) == {"/robot_description": 1, "/tf": states, "/step": states}


def test_where_a_body_can_touch_contacts_are_logged_though_it_never_does(tmp_path: Path) -> None:
    path = log_of(FLOOR, tmp_path)  # half a second of free fall from 5 m
    states = len(lavendersim.open_trace(path).step)
    found = messages(path)
    assert set(found) == ALWAYS | TOUCHING
    assert found.pop("/contact_columns") == 1  # a message of many steps
    assert {found[topic] for topic in TOUCHING - {"/contact_columns"}} == {states}
    contact = lavendersim.open_trace(path).contact
    assert len(contact["impulse_n"]) == 0


def test_residuals_are_logged_where_they_are_asked_for(tmp_path: Path) -> None:
    path = log_of(FLOOR + ASKED, tmp_path)
    assert set(messages(path)) == ALWAYS | TOUCHING | {"/residuals"}
    residual = lavendersim.open_trace(path).residual
    assert len(np.unique(residual["step"])) == messages(path)["/residuals"]


def test_where_nothing_can_touch_there_are_no_sweeps_to_log(tmp_path: Path) -> None:
    assert set(messages(log_of(FREE + ASKED, tmp_path))) == ALWAYS


def test_what_is_absent_is_explained_by_the_plan(tmp_path: Path) -> None:
    path = log_of(FREE, tmp_path)
    trace = lavendersim.open_trace(path)
    assert trace.metadata["plan"]["contact_log"] == "off: nothing can touch"
    for table, topic, why in (
        (trace.contact, "/contacts", "nothing can touch (plan: contact_log off)"),
        (trace.residual, "/residuals", "record.residuals is none (plan: residual_log off)"),
    ):
        with pytest.raises(UsageError) as caught:
            table["step"]
        assert str(caught.value) == f"{path}: this log has no {topic}: {why}"


def test_equal_runs_of_a_free_body_give_equal_bytes(tmp_path: Path) -> None:
    first, second = (log_of(FREE, tmp_path / name).read_bytes() for name in ("a", "b"))
    assert first == second


def test_every_topic_of_the_log_belongs_to_one_effect() -> None:
    topics = [topic for effect in EFFECTS for topic in effect.channels or ()]
    assert sorted(topics) == sorted(CHANNELS)
