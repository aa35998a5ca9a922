"""From YAML to the log: resistance to turning in the default numerics, and in the plan's words."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physics_runs import GRAVITY, Course, run_config

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.plan import plan_of

SCENE = """\
question: What stops a ball that turns?
expected: The torque of its load.
scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 0.5}}
    top:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [0, 1, 0.1]
      angular_velocity: [0, 0, 2]
      surface: {torsional_friction: 0.002}
    roller:
      shape: {kind: sphere, radius: 0.1}
      mass: 1
      position: [0, 0, 0.1]
      velocity: [0.05, 0, 0]
      angular_velocity: [0, 0.5, 0]
      surface: {friction: 0.5, rolling_friction: 0.001}
duration: 1.0
"""
DT = 1.0 / 240.0
# The default tolerance; each step is solved to it, and what it leaves adds up at worst.
TOLERANCE = 1e-8


@pytest.fixture(scope="module")
def course() -> Course:
    return run_config(SCENE)[0]


def decisions(text: str):
    return plan_of(load_experiment_text(text, "test.yaml").cells()[0].config).decisions


def test_a_spinning_ball_stops_by_the_torque_of_its_load(course: Course) -> None:
    rows = course.contacts_of("floor", "top")
    spin = rows["spin_n"][np.diff(rows["step"], append=241) > 0]  # at the end of each step
    expected = 2.0 - 0.002 * GRAVITY / 0.004 * DT * np.arange(1, 241)
    np.testing.assert_allclose(
        spin, np.maximum(expected, 0.0), atol=240 * TOLERANCE / 0.1, rtol=0.0
    )


def test_a_rolling_ball_slows_by_its_closed_form_and_rests(course: Course) -> None:
    x = course.pose[:, course.names.index("roller"), 0]
    slowing = 0.01 * GRAVITY / 1.4
    # It stops within a step: v t - a t^2/2 up to that instant.
    time = np.minimum(DT * np.arange(241), 0.05 / slowing)
    way = 0.05 * time - 0.5 * slowing * time**2
    np.testing.assert_allclose(np.diff(x) / DT, np.diff(way) / DT, atol=240 * TOLERANCE)


def test_plan_names_both_and_whom_they_concern() -> None:
    found = decisions(SCENE)
    torsional, rolling = (found[f"{kind}_friction"].reason for kind in ("torsional", "rolling"))
    assert torsional.startswith("floor and top: torsional friction 0.002 m; ")
    assert rolling.startswith("floor and roller: rolling friction 0.001 m; ")


@pytest.mark.parametrize("name", ["torsional_friction", "rolling_friction"])
def test_one_alone_brings_the_frame_it_acts_in(name: str) -> None:
    """No surface has friction: the block is there for its frame, its disc is a point."""
    other = ({"torsional_friction", "rolling_friction"} - {name}).pop()
    text = SCENE.replace("friction: 0.5, ", "").replace("surface: {friction: 0.5}", "surface: {}")
    for value in ("0.002", "0.001"):
        text = text.replace(f"{other}: {value}", f"{other}: 0")
    found = decisions(text)
    assert found[name].on
    assert not found[other].on
    assert "resistance to turning acts in friction's frame" in found["friction"].reason
    for needed in ("friction", "rotation", "contact_torque"):
        assert found[needed].on


def test_columns_reach_the_log_with_their_effect_and_not_without(tmp_path: Path) -> None:
    columns = {"angular_impulse_n", "angular_impulse_t1", "angular_impulse_t2"}
    path = tmp_path / "turning.yaml"
    text = SCENE.replace("duration: 1.0", "duration: 0.1\nnumerics: chapter")
    path.write_text(text)
    cell = lavendersim.run(path, root=tmp_path / "runs").run.cells[0]
    contact = cell.trace().contact
    assert columns <= set(contact.dtype.names)
    first = contact[contact["step"] == 1]
    np.testing.assert_allclose(
        sorted(first["angular_impulse_n"]), [-0.002 * GRAVITY * DT, 0.0], atol=1e-9
    )
    plain = text.replace(", rolling_friction: 0.001", "").replace("torsional_friction: 0.002", "")
    path.write_text(plain)
    cell = lavendersim.run(path, root=tmp_path / "runs").run.cells[0]
    assert not columns & set(cell.trace().contact.dtype.names)
