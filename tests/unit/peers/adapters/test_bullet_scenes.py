"""Bullet has what it was given, as multibodies and as plain rigid bodies."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL, BOX, needs

pytestmark = needs("bullet")
ROUND = """
scene:
  bodies:
    floor: {shape: {kind: plane, normal: [0, 1, 1], offset: -2}}
    pill: {shape: {kind: capsule, radius: 0.1, length: 0.5}, mass: 1, position: [0, 0, 1]}
    bar: {shape: {kind: cylinder, radius: 0.1, length: 0.5}, mass: 1, position: [5, 0, 1]}
duration: 1
"""


@pytest.mark.parametrize("variant", PEERS["bullet"].variants)
@pytest.mark.parametrize("text", [BALL, BOX, ROUND])
def test_a_scene_is_built_as_described(text: str, variant: str) -> None:
    from lavendersim.peers.adapters.bullet import World

    scene = Scene(load_experiment_text(text, "scene").cells()[0].config)
    world = World(scene, PEERS["bullet"].variants[variant].settings)
    assert misbuilt(scene, world, PEERS["bullet"]) == ""
