"""A cell by another engine: how it ends where its process goes wrong; topics and their reasons."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import compiling
from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.messages import Built, Ended, States
from lavendersim.runner import other_engine, run
from lavendersim.runner.other_engine import absent_topics
from lavendersim.trace import TraceWriter
from tests.engines import BALL, needs


def test_topics_that_an_engine_does_not_report_have_its_reason_and_others_the_plans() -> None:
    planned = {"/contacts": "nothing can touch"}
    absent = absent_topics(planned, PEERS["mujoco"], ())
    assert absent["/contacts"] == "nothing can touch"
    assert absent["/plot/force"] == absent["/residuals"] == "MuJoCo does not report it"
    assert "/contacts" not in absent_topics({}, PEERS["mujoco"], ("impulse_n",))


@needs("mujoco")
def test_a_crash_is_how_the_cell_ended_and_others_go_on(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The second process dies after its initial state; its log has that state."""
    whole = other_engine.messages_of
    started: list[str] = []

    def crashing(task: Any) -> Iterator[Any]:
        started.append(task.engine)
        if len(started) != 2:
            yield from whole(task)
            return
        yield Built("0", 1)
        pose, velocity = np.array([[[0.0, 0, 3, 1, 0, 0, 0]]]), np.zeros((1, 1, 6))
        yield States(0, pose, velocity, np.zeros((0, 3 + 12)), 1)
        yield Ended("crashed: its process was ended by SIGSEGV")

    monkeypatch.setattr(other_engine, "messages_of", crashing)
    swept = "sweep: {engine: {path: engine, values: [mujoco, mujoco-stiff, mujoco-cg]}}"
    finished = run(load_experiment_text(f"{BALL}{swept}\n", "ball.yaml"), tmp_path)
    reported = "failed: crashed: its process was ended by SIGSEGV after step 0"
    assert [cell.status for cell in finished.run.cells] == ["complete", reported, "complete"]
    assert [outcome.steps for outcome in finished.outcomes] == [50, 0, 50]
    assert not finished.good
    assert len(finished.run.cells[1].trace().step) == 1


@needs("mujoco")
def test_a_state_that_is_not_finite_ends_the_cell_as_it_does_by_lavender(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Of four states the third is none: it is the last of the log, with its contacts."""

    def diverging(task: Any) -> Iterator[Any]:
        yield Built("0", 1)
        pose = np.tile([0.0, 0, 3, 1, 0, 0, 0], (4, 1, 1))
        pose[2:, 0, 1] = np.nan
        contacts = np.zeros((4, 3 + len(PEERS["mujoco"].reported)))
        contacts[:, 0], contacts[:, 2] = range(4), 1
        counts = np.arange(4)
        yield States(0, pose, np.zeros((4, 1, 6)), contacts, 400, counts)
        yield Ended("")

    monkeypatch.setattr(other_engine, "messages_of", diverging)
    # the name is that of the body that moves, though one stands before it
    text = BALL.replace("bodies:", "bodies:\n    floor: {shape: {kind: plane}}")
    finished = run(load_experiment_text(f"{text}engine: mujoco\n", "ball.yaml"), tmp_path)
    (cell,), (outcome,) = finished.run.cells, finished.outcomes
    assert cell.status == "diverged: body ball is no longer finite after step 2 (t = 0.02 s)"
    assert (outcome.steps, outcome.physics_ns) == (2, 300)
    assert list(cell.trace().step["step"]) == [0, 1, 2]
    assert list(cell.trace().contact["step"]) == [0, 1, 2]


@needs("mujoco")
def test_kernels_that_lay_out_its_log_are_no_cost_of_logging(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    compiled, close = 10_000_000, TraceWriter.close  # [ns]

    def built(task: Any) -> Iterator[Any]:
        yield Built("0", 1)
        pose = np.array([[[0.0, 0, 3, 1, 0, 0, 0]]])
        yield States(0, pose, np.zeros((1, 1, 6)), np.zeros((0, 3 + 12)), 1)
        yield Ended("")

    def compiled_first(self: TraceWriter, *arguments: Any) -> Any:
        with compiling():
            time.sleep(1e-9 * compiled)
        return close(self, *arguments)

    monkeypatch.setattr(other_engine, "messages_of", built)
    monkeypatch.setattr(TraceWriter, "close", compiled_first)
    finished = run(load_experiment_text(f"{BALL}engine: mujoco\n", "ball.yaml"), tmp_path)
    assert finished.outcomes[0].compile_ns >= compiled
