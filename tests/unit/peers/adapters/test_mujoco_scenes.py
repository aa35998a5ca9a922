"""MuJoCo has every shape where lavender has it, and the friction of every pair."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.cell import CellBody, CellCompound
from lavendersim.experiment import load_experiment_text
from lavendersim.geometry.bodies import rotation_of
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import extent
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import needs

pytestmark = needs("mujoco")
SHAPES = (
    "{kind: sphere, radius: 0.3}",
    "{kind: box, size: [0.2, 0.4, 0.6]}",
    "{kind: capsule, radius: 0.1, length: 0.5}",
    "{kind: cylinder, radius: 0.2, length: 0.3}",
    "{kind: hull, points: [[0, 0, 0], [0.5, 0, 0], [0, 0.4, 0], [0, 0, 0.9]]}",
    "{kind: compound, parts: [{shape: {kind: sphere, radius: 0.3}},"
    " {shape: {kind: box, size: [0.2, 0.4, 0.6]}, position: [0.5, 0, 0.1]}]}",
)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda text: text.split()[1].strip(","))
def test_a_shape_is_as_far_from_a_plane_as_its_extent_says(shape: str) -> None:
    """Turned, above the floor. Corners of meshes are numbers of 24 bits: 6e-8 of 1 m."""
    from lavendersim.peers.adapters.mujoco import World

    text = f"""
scene:
  gravity: [0, 0, 0]
  bodies:
    floor: {{shape: {{kind: plane}}}}
    body: {{shape: {shape}, mass: 2, position: [0, 0, 0.7], orientation: [1, 0.3, -0.2, 0.5]}}
duration: 1
"""
    config = load_experiment_text(text, "shape").cells()[0].config
    scene = Scene(config)
    world = World(scene, {"margin": 2.0})
    assert misbuilt(scene, world, PEERS["mujoco"]) == ""
    world.step()
    gaps = [row[8] for row in world.contacts()]
    assert min(gaps) == pytest.approx(lowest(config.scene.bodies["body"]), abs=6e-8)


def lowest(body: CellBody) -> float:
    """Return the height of the lowest point of a body, part by part [m]."""
    turn = rotation_of(body)
    parts = [(body.shape, turn, np.zeros(3))]
    if isinstance(body.shape, CellCompound):
        parts = [
            (part.shape, turn @ rotation_matrix(unit_quaternion(part.orientation)), part.position)
            for part in body.shape.parts
        ]
    down = np.array([0.0, 0.0, -1.0])
    return min(
        float(body.position[2] + (turn @ np.asarray(place))[2] - extent(shape, own, down))
        for shape, own, place in parts
    )


def test_pairs_of_any_surfaces_have_their_mixture() -> None:
    """Four surfaces and no rule of bodies: pairs are named one by one, and none is forgotten."""
    from lavendersim.peers.adapters.mujoco import World

    text = """
scene:
  gravity: [0, 0, 0]
  surfaces: {a: {friction: 0.1}, b: {friction: 0.4}, c: {friction: 0.9}}
  bodies:
    floor: {shape: {kind: plane}, surface: a}
    one: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 0.99], surface: b}
    two: {shape: {kind: sphere, radius: 1}, mass: 1, position: [1.9, 0, 0.99], surface: c}
duration: 1
"""
    scene = Scene(load_experiment_text(text, "pairs").cells()[0].config)
    assert scene.by_first(("friction", "restitution")) is None
    world = World(scene, {})
    world.step()
    found = {tuple(sorted(row[:2])): row[-1] for row in world.contacts()}
    required = {(0, 1): 0.2, (0, 2): 0.3, (1, 2): 0.6}
    assert found == pytest.approx(required, rel=1e-12)
