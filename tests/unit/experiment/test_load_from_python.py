"""A config from Python: its path, its text or a mapping, with overrides, are one experiment."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import lavendersim
from lavendersim import load_experiment
from lavendersim.errors import ConfigError, UsageError

TEXT = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.5]}
numerics: {timestep: 1/480}
duration: 0.1
"""
MAPPING = {
    "scene": {
        "bodies": {
            "floor": {"shape": {"kind": "plane"}},
            "ball": {
                "shape": {"kind": "sphere", "radius": np.float64(0.1)},
                "mass": 1.0,
                "position": np.array([0.0, 0.0, 0.5]),
            },
        },
    },
    "numerics": {"timestep": Fraction(1, 480)},
    "duration": 0.1,
}


def resolved(config: object, **words: object) -> dict:
    (cell,) = load_experiment(config, **words).cells()
    return cell.config.as_dict()


def test_a_path_a_text_and_a_mapping_are_one_experiment(tmp_path: Path) -> None:
    file = tmp_path / "drop.yaml"
    file.write_text(TEXT)
    assert resolved(file) == resolved(str(file)) == resolved(TEXT) == resolved(MAPPING)


@pytest.mark.parametrize(
    "overrides",
    [["set numerics.timestep=1/960"], {"numerics.timestep": Fraction(1, 960)}],
    ids=["texts", "mapping"],
)
def test_overrides_are_texts_or_a_mapping(overrides: object) -> None:
    changed = {**MAPPING, "numerics": {"timestep": "1/960"}}
    assert resolved(TEXT, overrides=overrides) == resolved(changed)
    place = {"scene.bodies.ball.position": np.array([0.0, 0.0, 0.7])}
    assert resolved(TEXT, overrides=place)["scene"]["bodies"]["ball"]["position"] == [0.0, 0.0, 0.7]


def test_what_is_wrong_with_a_mapping_has_its_place_in_the_text_of_it() -> None:
    with pytest.raises(ConfigError, match=r'^config:\d+:\d+: .*did you mean "duration"'):
        load_experiment({**MAPPING, "duraton": 1.0})
    with pytest.raises(UsageError, match="has no place in a config"):
        load_experiment({**MAPPING, "duration": {1.0}})


def test_a_run_takes_them_too(tmp_path: Path) -> None:
    finished = lavendersim.run(MAPPING, root=tmp_path, overrides={"duration": 0.05})
    assert finished.good
    (cell,) = finished.run.cells
    assert len(cell.trace().step) == 25  # 0.05 s at 1/480 s, and the start
    again = load_experiment(MAPPING)
    with pytest.raises(UsageError, match="give them to load_experiment"):
        lavendersim.run(again, root=tmp_path, overrides={"duration": 0.05})
