"""Where the file has what an engine cannot do: names, own surfaces, pairs, arranged bodies."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

NAMED = """\
engine: mujoco
scene:
  surfaces:
    soft: {friction: 0.5, compliance: 1e-4}
    hard: {friction: 0.5}
  bodies:
    floor: {shape: {kind: plane}, surface: hard}
    one: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [1, 0, 1], surface: soft}
    two: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [2, 0, 1], surface: soft}
duration: 1
"""
ARRANGED = """\
engine: mujoco
scene:
  surfaces:
    hard: {friction: 0.5}
    soft: {friction: 0.5, compliance: 1e-4}
  bodies:
    floor: {shape: {kind: plane}, surface: hard}
  arrangements:
    tower:
      kind: tower
      count: 3
      body: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1, surface: soft}
duration: 1
"""
OWN = """\
engine: mujoco
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1],
           surface: {rolling_friction: 0.1}}
    b: {shape: {kind: sphere, radius: 1}, mass: 1, position: [9, 0, 0],
        surface: {rolling_friction: 0.1}}
duration: 1
"""
PAIR = """\
engine: mujoco
scene:
  surfaces: {a: {friction: 0.5}, b: {friction: 0.5}}
  surface_pairs:
    worn: {between: [a, b], torsional_friction: 0.1}
  bodies:
    floor: {shape: {kind: plane}, surface: a}
    ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 1], surface: b}
duration: 1
"""


def places(text: str) -> list[tuple[int, str]]:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "c.yaml")
    return [(one.line, one.message.partition(":")[0]) for one in refused.value.defects]


def test_a_surface_of_several_bodies_is_one_place() -> None:
    assert places(NAMED) == [(4, "compliance")]
    assert places(ARRANGED) == [(5, "compliance")]


def test_each_body_with_a_surface_of_its_own_is_a_place() -> None:
    assert places(OWN) == [(6, "rolling_friction"), (8, "rolling_friction")]


def test_a_property_of_a_pair_is_refused_in_the_pair() -> None:
    assert places(PAIR) == [(5, "torsional_friction")]
