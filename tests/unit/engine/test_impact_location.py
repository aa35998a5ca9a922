"""What overlaps and parts has not met: parts of a step go on from it."""

from __future__ import annotations

import numpy as np

from lavendersim.engine.records import DIVERGED
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
from tests.families_of_plans import spec_of_family

# Its rim lands at a speed at which it rebounds by 0.016 m/s from 18 um inside, and does not get out
# of there in the step: 0.0156^2/(2 g) = 12 um.
PLATE = """
question: Does a plate that overlaps and parts meet at once?
scene:
  surfaces: {metal: {friction: 0.3, restitution: 0.3}}
  bodies:
    floor: {shape: {kind: plane}, surface: metal}
    plate:
      shape: {kind: cylinder, radius: 0.1, length: 0.005}
      mass: 0.3
      surface: metal
      orientation: {axis: [1, 0, 0], degrees: 3}
      angular_velocity: [0, 0, 3]
      release: {above: floor, clearance: 0.003, phase: 0}
duration: 0.125
"""
# Rows that rebound with e = 0.3 are slower by a decade after two impacts: some tens of parts.
MOST = 64


def test_a_point_that_overlaps_and_parts_is_not_met_again_and_again() -> None:
    """A part that ends as it begins, 2e-12 s long, was made until the work of the step was spent:
    257 parts, and the rest of the step without order.
    """
    cell = load_experiment_text(PLATE, "plate.yaml").cells()[0]
    spec = spec_of_family(plan_of_cell(cell))
    engine = build(cell.config, spec).engine(spec)
    rows = []
    while engine.counters["step"][0] < cell.config.steps:
        assert engine.advance(1) != DIVERGED
        rows.append(engine.take_rows().step["parts"])
    _, *parts = np.concatenate(rows)  # the state before the first step is a row, too
    assert len(parts) == 30
    assert max(parts) < MOST
