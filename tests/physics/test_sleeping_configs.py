"""From YAML to the log: balls asleep on a floor pass a blow on, one waking the next.

Default numerics, and more pairs than are looked at one by one. Equal masses and e = 1: each ball
that is hit leaves with the whole speed of the one that hit it, which stays where it is.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physics_runs import Course, run_config

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import plan_of

SCENE = """\
question: Does a ball that sleeps pass a blow on?
expected: As if it had been awake.
scene:
  bodies:
    floor: {shape: {kind: plane}}
    cue:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      surface: {restitution: 1}
      position: [-4, 0, 0.1]
      velocity: [4, 0, 0]
  arrangements:
    row:
      kind: grid
      counts: [6, 6, 1]
      spacing: [0.5, 0.5, 0.5]
      origin: [0, 0, 0.1]
      body: {shape: {kind: sphere, radius: 0.1}, mass: 1, surface: {restitution: 1}}
numerics: {sleeping: true}
duration: 1.5
"""
# 3.8 m to the first ball at 4 m/s, five times 0.3 m to the next.
FIRST, LAST = 0.95, 0.95 + 5 * 0.3 / 4.0
DT = 1.0 / 240.0


@pytest.fixture(scope="module")
def course() -> Course:
    return run_config(SCENE)[0]


def test_all_sleep_until_the_cue_arrives(course: Course) -> None:
    awake = course.step["awake"]
    assert awake[0] == 37
    times = DT * np.arange(len(awake))
    waiting = (times > 0.6) & (times < FIRST - 2 * DT)
    assert (awake[waiting] == 1).all()
    # Then at most the six of the first line, each for half a second, and the cue.
    assert awake[times > FIRST + DT].max() <= 7


def test_the_blow_reaches_the_last_ball_undiminished(course: Course) -> None:
    order = [course.names.index(name) for name in course.names if name.startswith("row_")]
    line = [i for i in order if course.pose[0, i, 1] == 0.0]
    last = max(line, key=lambda i: course.pose[0, i, 0])
    assert len(line) == 6
    x = course.pose[:, last, 0]
    impact = int(LAST / DT)
    # Impacts are solved to the default tolerance of 1e-8 m/s, six of them.
    np.testing.assert_allclose(np.diff(x)[impact + 2 :] / DT, 4.0, atol=1e-6)
    np.testing.assert_allclose(x[: impact - 1], 2.5, atol=1e-9)
    others = [i for i in order if i not in line]
    asleep = int(0.6 / DT)
    held = course.pose[asleep:, others]
    assert (held == held[0]).all()


def test_plan_names_who_may_sleep_and_off_is_the_default() -> None:
    def decision(text: str):
        return plan_of(load_experiment_text(text, "t.yaml").cells()[0].config).decisions

    on = decision(SCENE)["sleeping"]
    assert on.on
    assert on.reason.startswith("sleeping is true: cue, ")
    off = decision(SCENE.replace("numerics: {sleeping: true}\n", ""))["sleeping"]
    assert not off.on
    assert off.reason == "sleeping is false"


def test_the_log_counts_who_is_awake(tmp_path: Path) -> None:
    path = tmp_path / "sleep.yaml"
    text = SCENE.replace("duration: 1.5", "duration: 0.7").replace("{sleeping: true}", "{}")
    path.write_text(text.replace("numerics: {}", "numerics: {preset: chapter, sleeping: true}"))
    cell = lavendersim.run(path, root=tmp_path / "runs").run.cells[0]
    awake = cell.trace().step["awake"]
    assert awake[0] == 37
    assert awake[-1] == 1
