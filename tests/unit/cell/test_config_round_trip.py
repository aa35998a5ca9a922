"""A resolved cell and its plain data are one thing: what is logged can be read back as it was."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest

from lavendersim.cell import CellConfig, CellTimestep, TimeWindow
from lavendersim.experiment import load_experiment, load_experiment_text

CONFIGS = Path(__file__).parents[3] / "configs"
FILES = sorted(CONFIGS.rglob("*.yaml"))
MOST_CELLS = 5  # of one file: the first, the last and those evenly between

EVERYTHING = """
scene:
  gravity: {slope: 1/7, azimuth_degrees: 30}
  surfaces: {rubber: {restitution: 1/3, friction: 0.7, compliance: 1e-6}}
  bodies:
    ground: {shape: {kind: plane}, surface: rubber, surface_velocity: [1.0, 0.0, 0.0]}
    ball:
      shape: {kind: sphere, radius: 0.1}
      density: 1000
      release: {above: ground, clearance: 1, phase: 3/16}
      drag: {linear: 0.1}
    turned:
      shape: {kind: compound, parts: [
        {shape: {kind: box, size: [0.1, 0.2, 0.3]}, position: [0.3, 0.0, 0.1]},
        {shape: {kind: hull, points: [[0,0,0], [1,0,0], [0,1,0], [0,0,1], [1,1,1]]}}]}
      mass: 2
      position: [3.0, 0.0, 2.0]
  arrangements:
    tower:
      kind: tower
      count: 3
      base: [-3.0, 0.0, 0.0]
      body: {shape: {kind: cylinder, radius: 0.1, length: 0.2}, mass: 1}
  forces: [{body: ball, from: 0.25, force: [1.0, 0.0, 0.0]}]
events:
  - {at: 0.5, timestep: 1/480}
  - {at: 0.5, body: turned, remove: true}
numerics: {timestep: 1/240, tolerance: null}
duration: 1
record: {residuals: {from: 0.1, to: 0.2}, problems: every 10}
effects: {sphere_plane: "on"}
"""


def check(config: CellConfig) -> None:
    data = config.as_dict()
    again = CellConfig.from_dict(json.loads(json.dumps(data)))
    assert again == config
    assert json.dumps(again.as_dict()) == json.dumps(data)  # the order of bodies counts


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(CONFIGS)))
def test_the_cells_of_a_shipped_config_come_back(file: Path) -> None:
    cells = load_experiment(file).cells()
    for cell in cells[:: max(1, len(cells) // MOST_CELLS)]:
        check(cell.config)


def test_everything_that_a_cell_can_hold_comes_back_with_its_types() -> None:
    config = load_experiment_text(EVERYTHING, "all.yaml").cells()[0].config
    check(config)
    again = CellConfig.from_dict(config.as_dict())
    assert again.numerics.timestep == Fraction(1, 240)
    assert again.scene.bodies["ball"].release is not None
    assert again.scene.bodies["ball"].release.phase == Fraction(3, 16)
    assert isinstance(again.events[0], CellTimestep)
    assert again.record.residuals == TimeWindow.model_validate({"from": 0.1, "to": 0.2})


def test_a_key_that_no_cell_has_is_refused() -> None:
    data = load_experiment_text(EVERYTHING, "all.yaml").cells()[0].config.as_dict()
    with pytest.raises(ValueError, match="grvity"):
        CellConfig.from_dict(data | {"grvity": 9.81})
