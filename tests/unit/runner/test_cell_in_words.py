"""What a cell's log says of its plan and of its end, and what is left where its process died."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.engine.engine import Rows
from lavendersim.engine.records import INACCURATE, NOT_FINITE, TURNS_TOO_FAST
from lavendersim.experiment import load_experiment_text
from lavendersim.measures.specs.always import Always
from lavendersim.record_tables import with_room
from lavendersim.runner.cell import (
    CellJob,
    CellOfLog,
    block_of,
    divergence,
    failed,
    interrupted,
    plan_in_log,
)
from lavendersim.scene.plan import Plan, plan_of
from tests.made_cells import made_cell
from tests.marked_config import BALL, FLOOR, config, scene

CELL = made_cell({"ball": {"shape": {"kind": "sphere", "radius": 0.1}}}, numerics={"timestep": "1/3"})  # noqa: E501  # fmt: skip
SCENE: Any = SimpleNamespace(names=["floor", "ball"], clock=CELL.clock)


def plan(**sections: str) -> Plan:
    return plan_of(load_experiment_text(config(**sections), "a.yaml").cells()[0].config)


def engine(cause: int, **counters: Any) -> Any:
    row = {"step": 4, "body": 1, "cause": cause, "substeps": 3, **counters}
    record = {"length": 1e-6, "error": 0.25, "start": 0.125}
    parameters = [{"accuracy": 1e-3, "smallest_timestep": 1e-6}]
    return SimpleNamespace(counters=[row], parameters=parameters, state=SimpleNamespace(control=SimpleNamespace(record=[record])))  # noqa: E501  # fmt: skip


@pytest.mark.parametrize(
    ("cause", "words"),
    [
        (NOT_FINITE, "is no longer finite"),
        (TURNS_TOO_FAST, "turns too far in one timestep for its rotation to be solved"),
    ],
)
def test_a_divergence_names_body_step_and_time(cause: int, words: str) -> None:
    said = divergence(SCENE, engine(cause))
    assert said == f"diverged: body ball {words} after step 4 (t = 1.33333333 s)"


def test_a_substep_that_cannot_be_says_which_bound_it_met() -> None:
    said = divergence(SCENE, engine(INACCURATE))
    assert "cannot be made as accurate as asked for (0.001)" in said
    assert "none may be shorter than 1e-06 s" in said
    assert said.endswith("(t = 1.45833333 s)")  # 4/3 s, and 1/8 s of the step
    assert "its step has had" in divergence(SCENE, engine(INACCURATE, substeps=10**9))


def test_an_interruption_names_its_signal() -> None:
    said = interrupted(CELL.clock, "SIGTERM", 3)
    assert said == "interrupted by SIGTERM after step 3 (t = 1 s)"


def test_rows_of_a_log_have_the_time_of_their_step_in_whole_nanoseconds() -> None:
    step = np.zeros(4, with_room(np.dtype([("step", "i8"), ("x", "f8")])))
    step["step"], step["x"] = [0, 1, 2, 3], [5.0, 6.0, 7.0, 8.0]
    none = np.zeros(0)
    block = block_of(Rows(step=step, contact=none, pose=none, residual=none), CELL.clock)
    assert block.step["time_ns"].tolist() == [0, 333_333_333, 666_666_666, 1_000_000_000]
    assert block.step["x"].tolist() == [5.0, 6.0, 7.0, 8.0]


def test_a_log_says_of_every_effect_whether_it_is_on_and_why() -> None:
    one = plan()
    found = plan_in_log(one)
    said = found.metadata["plan"]
    assert {name for name, words in said.items() if words.startswith("on: ")} == set(
        one.spec.effects
    )
    assert said["drag"] == "off: no body has drag"
    assert "forced" not in found.metadata
    assert "study-only" not in found.metadata
    assert set(found.metadata["shape pairs"]) == set(one.spec.shape_pairs)


def test_topics_that_a_log_does_without_have_the_reason_of_the_plan() -> None:
    alone = "{bodies: {ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}}}"
    absent = plan_in_log(plan(scene=alone)).absent
    assert absent["/contacts"].endswith("(plan: contact_log off)")
    assert "/step" not in absent
    assert "/contacts" not in plan_in_log(plan()).absent


def test_what_is_forced_and_a_deliberate_error_stand_in_the_log() -> None:
    bouncing = scene(FLOOR, BALL.replace("mass", "surface: {restitution: 0.5}, mass"))
    study = {"numerics": "chapter", "study": "{mistake: capture_in_sweeps}"}
    mistaken = plan(scene=bouncing, **study)
    assert "deliberate error" in str(plan_in_log(mistaken).metadata["study-only"])
    forced = plan(effects="{drag: on}")
    assert "drag" in plan_in_log(forced).metadata["forced"]


def test_of_a_cell_whose_process_died_nothing_is_measured_and_every_check_fails() -> None:
    cells = (CellOfLog(0, "e=1", {"e": 1}), CellOfLog(7, "e=2", {"e": 2}))
    experiment = load_experiment_text(config(measure="{d: {kind: simulated_duration}}"), "a.yaml")
    job = CellJob(0, CELL, "", Path("a.mcap"), plan(), "", Always(), experiment.measures, cells)
    ended = failed(job, "was killed (SIGKILL)")
    status = "failed: its process was killed (SIGKILL), both times"
    assert (ended.outcome.status, ended.outcome.steps, ended.outcome.log) == (status, 0, None)
    assert set(ended.measured) == {0, 7}
    for one in ended.measured.values():
        assert one.values == {"d": status}
        assert not any(outcome.passed for outcome in one.always.values())
        assert "residual" in one.always


def test_a_job_for_another_process_says_nothing_of_other_cells() -> None:
    whole = plan()._replace(cells=(1, 2), reasons={"drag": ("a",)})
    job = CellJob(0, CELL, "", Path("a.mcap"), whole, "")
    alone = job.alone()
    assert (alone.plan.cells, alone.plan.reasons, alone.plan.spec) == ((), {}, whole.spec)
    assert alone.in_log == plan_in_log(whole)
