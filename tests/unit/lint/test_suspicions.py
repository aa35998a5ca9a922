"""Suspicions stand in the order of the file, once each; shipped configs give none unmeant."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

from lavendersim.errors import ConfigError, SuspiciousScene
from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.lint import suspicions, warn
from tests.unit.lint.scenes import config, found

CONFIGS = Path(__file__).parents[3] / "configs"
SWEPT = """sweep:
  x: {path: scene.bodies.a.position, values: [[0, 0, 0.5], [0, 0, 0.4], [0, 0, 0.3]]}
  m: {path: scene.bodies.a.mass, values: [1, 2, 3]}
always: {}
"""
BALL = "a: {shape: {kind: sphere, radius: 0.5}, mass: 1, position: [0, 0, 0.5]}"
# Scenes whose question is such a start, or that a search found as they stand.
MEANT = {
    "hard/control/gain_of_one.yaml",
    "hard/degenerate/same_place.yaml",
    "hard/found/cohesion_of_what_turns.yaml",
    "hard/found/forces_beside_a_union_that_is_placed.yaml",
    "hard/found/levers_of_what_flies_past.yaml",
    "hard/found/part_that_waits_for_room.yaml",
    "hard/found/push_ahead_of_a_stiff_spring.yaml",
    "hard/found/springs_beside_what_gives_way.yaml",
    "hard/found/sweeps_of_a_step_solved_anew.yaml",
    "hard/found/torque_beyond_its_cone.yaml",
    "hard/found/turn_of_a_middle_not_found.yaml",
    "hard/found/work_of_a_turn_without_digits.yaml",
    "hard/overlap/pyramid_pressed.yaml",
    "hard/overlap/sheet_of_balls.yaml",
}


def test_every_value_of_a_sweep_is_looked_at_and_each_place_reported_once() -> None:
    places = [(defect.line, defect.column) for defect in found(config(BALL, rest=SWEPT))]
    line = SWEPT.splitlines()[1]
    columns = [line.index(value) + 1 for value in ("[0, 0, 0.4]", "[0, 0, 0.3]")]
    assert [column for _, column in places] == columns
    assert places == sorted(places)


def test_a_suspicion_is_a_warning_or_where_strict_an_error() -> None:
    text = config(BALL, rest="")
    experiment = load_experiment_text(text, "scene.yaml")
    with pytest.warns(SuspiciousScene, match=r"^scene.yaml:1:1: warning: nothing is claimed"):
        warn(experiment)
    with pytest.raises(ConfigError, match=r"^scene.yaml:1:1: nothing is claimed"):
        warn(experiment, strict=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn(load_experiment_text(config(BALL), "scene.yaml"), strict=True)


def test_of_the_shipped_configs_only_those_are_suspicious_that_mean_to_be() -> None:
    files = sorted(CONFIGS.rglob("*.yaml"))
    found_in = {
        str(file.relative_to(CONFIGS))
        for file in files
        if suspicions(load_experiment(file, reduced=True))
    }
    assert found_in == MEANT
