"""Contacts of bodies where they stand, against distances by hand; memory grows as it has to."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.engine.contacts_at_pose import contacts_at_pose
from lavendersim.engine.engine import Engine
from lavendersim.experiment.load import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

TWO = """\
question: Where do they touch?
expected: Half way.
scene:
  bodies:
    floor: {shape: {kind: plane}}
    low: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.1]}
    high: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0.31]}
duration: 1
"""


def engine(text: str) -> Engine:
    config = load_experiment_text(text, "touch.yaml").cells()[0].config
    spec = plan_of(config, record=False).spec
    kept = {"broad_phase", "rotation"} & set(spec.effects) | {"speculative"}
    spec = spec._replace(effects=tuple(sorted(kept)), solver="projected_gauss_seidel")
    return build(config, spec).engine(spec)


def test_gaps_are_those_by_hand_as_far_as_bodies_reach() -> None:
    made = engine(TWO)
    near = contacts_at_pose(made)
    assert near["phi"].tolist() == [0.0]  # the floor and the low one; the other is 10 mm away
    made.state.motion["reach"] = 0.02
    found = contacts_at_pose(made)
    assert sorted(found["phi"]) == pytest.approx([0.0, 0.01], abs=1e-16)
    between = found[found["a"] > 0]
    assert between["z"].tolist() == pytest.approx([0.205])
    made.bodies["x"][2] = 1.0
    assert len(contacts_at_pose(made)) == 1


def test_rows_are_made_for_as_many_contacts_as_there_are() -> None:
    """Of three bodies at one place each touches each."""
    made = engine(TWO)
    made.state = made.state._replace(contacts=made.contacts[:1].copy())
    made.bodies["z"] = 0.1
    assert len(contacts_at_pose(made)) == 3
    assert len(made.contacts) >= 3


def test_bodies_do_not_move() -> None:
    made = engine(TWO)
    before = made.bodies.copy()
    made.state.motion["reach"] = 1.0
    contacts_at_pose(made)
    assert np.array_equal(made.bodies, before)
