"""What an engine has otherwise than it was described is said, and a step that has no room."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL, log_of, needs, run_by


class Built:
    """A ball in an engine that keeps what it is given, but for one number."""

    def __init__(self, change: str = "", by: float = 0.0) -> None:
        self.state: dict[str, Any] = {
            "inertias": np.array([[2.0, 0.008, 0.008, 0.008]]),
            "poses": np.array([[0.0, 0.0, 3.0, -1.0, 0.0, 0.0, 0.0]]),
            "velocities": np.array([[1.0, 0.0, 2.0, 0.0, 3.0, 0.0]]),
        }
        self.state["friction"] = np.zeros((1, 1))
        if change:
            name, column = change.split()
            self.state[name][0, int(column)] += by

    def inertias(self) -> Any:
        return self.state["inertias"]

    def poses(self) -> Any:
        return self.state["poses"]

    def velocities(self) -> Any:
        return self.state["velocities"]

    def mixed(self) -> Any:
        return self.state["friction"], np.zeros_like(self.state["friction"])


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ("inertias 0", "mass"),
        ("inertias 3", "inertia"),
        ("poses 1", "position"),
        ("poses 4", "orientation"),
        ("velocities 2", "velocity"),
        ("velocities 5", "angular velocity"),
    ],
)
def test_a_number_that_differs_is_named_with_its_body(change: str, what: str) -> None:
    scene = Scene(load_experiment_text(BALL, "ball.yaml").cells()[0].config)
    peer = PEERS["mujoco"]
    assert misbuilt(scene, Built(), peer) == ""  # -q is q
    assert misbuilt(scene, Built(change, 1e-15), peer) == ""
    said = misbuilt(scene, Built(change, 1e-6), peer)
    assert said.startswith(f"MuJoCo has another {what} of ball: ")


def test_a_friction_that_the_engine_mixes_otherwise_is_named_with_its_bodies() -> None:
    """Of 0.2 and 0.8 lavender takes 0.4. Pairs that never move mean nothing to anybody."""
    text = """
scene:
  surfaces: {low: {friction: 0.2}, high: {friction: 0.8}}
  bodies:
    floor: {shape: {kind: plane}, surface: low}
    wall: {shape: {kind: plane, normal: [1, 0, 0], offset: -9}, surface: low}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 3],
           velocity: [1, 0, 2], angular_velocity: [0, 3, 0], surface: high}
duration: 1
"""
    scene = Scene(load_experiment_text(text, "c.yaml").cells()[0].config)
    built, peer = Built(), PEERS["mujoco"]
    right = np.array([[np.nan, np.nan, 0.4], [np.nan, np.nan, 0.4], [0.4, 0.4, np.nan]])
    built.state["friction"] = right
    assert misbuilt(scene, built, peer) == ""
    for off in (0.5, np.nan):
        built.state["friction"] = np.where(np.arange(3) == 1, off, right.T).T
        why = misbuilt(scene, built, peer)
        assert why.startswith("MuJoCo has another friction between wall and ball: ")
        assert why.endswith(", expected 0.4")


# 225 boxes 1 mm deep in a floor: 900 contacts, which take a megabyte as MuJoCo lays them out, and
# four rows of constraint each, for which there is no room beside them; 512 have it.
FLOOR_OF_BOXES = """
scene:
  surfaces: {rubber: {friction: 0.3}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
  arrangements:
    box: {kind: grid, counts: [15, 15, 1], spacing: [0.3, 0.3, 1], origin: [0, 0, 0.099],
          body: {shape: {kind: box, size: [0.2, 0.2, 0.2]}, mass: 1, surface: rubber}}
numerics: {timestep: 1/240}
duration: 1/120
"""


@needs("mujoco")
def test_a_step_whose_contacts_have_no_room_ends_the_run_with_a_sentence(tmp_path: Path) -> None:
    """It is no step: states end before it. With more memory the same scene goes through."""
    full = run_by(FLOOR_OF_BOXES, "mujoco", tmp_path, "engines: {mujoco: {memory: 1}}")
    status = full.outcomes[0].status
    assert status.startswith("failed: MuJoCo had no room for the contacts of a step (512 MB, or ")
    assert status.endswith("after step 0")
    assert log_of(full).step["step"].tolist() == [0]
    enough = run_by(FLOOR_OF_BOXES, "mujoco", tmp_path)
    assert enough.outcomes[0].status == "complete"
    assert len(log_of(enough).step) == 3


# A contact a ball, each a problem of its own.
FLOOR_OF_BALLS = """
scene:
  bodies:
    floor: {shape: {kind: plane}}
  arrangements:
    ball: {kind: grid, counts: [27, 37, 1], spacing: [0.3, 0.3, 1], origin: [0, 0, 0.099],
           body: {shape: {kind: sphere, radius: 0.1}, mass: 1}}
numerics: {timestep: 1/240}
duration: 1/120
"""


@needs("dart")
@pytest.mark.parametrize(("rows", "carried", "is_full"), [(27, 999, False), (28, 1000, True)])
def test_dart_is_full_at_the_limit_of_contacts_that_it_really_has(
    rows: int, carried: int, is_full: bool
) -> None:
    """Of 28 by 37 balls 36 have no contact and fall on."""
    from lavendersim.peers.adapters import dart

    text = FLOOR_OF_BALLS.replace("[27,", f"[{rows},")
    world = dart.World(Scene(load_experiment_text(text, "balls.yaml").cells()[0].config), {})
    world.step()
    falling = np.count_nonzero(world.velocities()[:, 2] < -0.5 * 9.81 / 240)
    assert (len(world.contacts()), falling) == (carried, rows * 37 - carried)
    assert world.is_full() == is_full
