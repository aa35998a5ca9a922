"""What an engine has otherwise than it was described is said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL


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
