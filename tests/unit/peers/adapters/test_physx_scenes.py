"""PhysX has what it was given, in single precision, and every shape where lavender has it."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL, BOX, SHAPES, needs, placed

pytestmark = needs("physx")
PEER = PEERS["physx"]


@pytest.mark.parametrize("variant", PEER.variants)
@pytest.mark.parametrize("text", [BALL, BOX])
def test_a_scene_is_built_as_described(text: str, variant: str) -> None:
    from lavendersim.peers.adapters.physx import World

    scene = Scene(load_experiment_text(text, "scene").cells()[0].config)
    assert misbuilt(scene, World(scene, PEER.variants[variant].settings), PEER) == ""


@pytest.mark.parametrize("kind", sorted(PEER.shapes - {"plane"}))
def test_a_shape_is_as_far_from_a_plane_as_its_extent_says(kind: str) -> None:
    """1 mm above the floor, within the distance at which it makes contacts. 24 bits of 1 m: 6e-8,
    through a turn, a plane and a difference.
    """
    from lavendersim.peers.adapters.physx import World

    scene = Scene(placed(SHAPES[kind], 1e-3))
    world = World(scene, {})
    assert misbuilt(scene, world, PEER) == ""
    world.step()
    assert min(row[8] for row in world.contacts()) == pytest.approx(1e-3, abs=1e-6)
