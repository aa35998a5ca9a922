"""MuJoCo has every shape where lavender has it, and the friction of every pair."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import SHAPES, needs, placed

pytestmark = needs("mujoco")


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_a_shape_is_as_far_from_a_plane_as_its_extent_says(shape: str) -> None:
    """Turned, above the floor. Corners of meshes are numbers of 24 bits: 6e-8 of 1 m."""
    from lavendersim.peers.adapters.mujoco import World

    scene = Scene(placed(shape, 0.01))
    world = World(scene, {"margin": 2.0})
    assert misbuilt(scene, world, PEERS["mujoco"]) == ""
    world.step()
    gaps = [row[8] for row in world.contacts()]
    assert min(gaps) == pytest.approx(0.01, abs=6e-8)


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
    assert misbuilt(scene, world, PEERS["mujoco"]) == ""
    world.step()
    found = {tuple(sorted(row[:2])): row[-1] for row in world.contacts()}
    required = {(0, 1): 0.2, (0, 2): 0.3, (1, 2): 0.6}
    assert found == pytest.approx(required, rel=1e-12)
