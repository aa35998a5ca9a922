"""DART has what it was given, and its shapes where lavender has them."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL, BOX, SHAPES, needs, placed

pytestmark = needs("dart")
PEER = PEERS["dart"]


@pytest.mark.parametrize("variant", PEER.variants)
@pytest.mark.parametrize("text", [BALL, BOX])
def test_a_scene_is_built_as_described(text: str, variant: str) -> None:
    from lavendersim.peers.adapters.dart import World

    scene = Scene(load_experiment_text(text, "scene").cells()[0].config)
    assert misbuilt(scene, World(scene, PEER.variants[variant].settings), PEER) == ""


@pytest.mark.parametrize("variant", PEER.variants)
@pytest.mark.parametrize("kind", sorted(PEER.shapes - {"plane"}))
def test_a_shape_is_as_deep_in_a_plane_as_its_extent_says(kind: str, variant: str) -> None:
    from lavendersim.peers.adapters.dart import World

    scene = Scene(placed(SHAPES[kind], -1e-3))
    world = World(scene, PEER.variants[variant].settings)
    assert misbuilt(scene, world, PEER) == ""
    world.step()
    assert min(row[8] for row in world.contacts()) == pytest.approx(-1e-3, abs=1e-9)


@pytest.mark.parametrize("detector", ["fcl", "bullet", "dart"])
@pytest.mark.parametrize("kind", sorted(PEER.shapes - {"plane"}))
def test_every_detector_finds_a_body_as_deep_as_it_is(kind: str, detector: str) -> None:
    """The setting `detector` is what finds contacts; a name for it is one of DART's own."""
    from lavendersim.peers.adapters.dart import World

    scene = Scene(placed(SHAPES[kind], -1e-3))
    world = World(scene, {"detector": detector})
    assert world._world.getConstraintSolver().getCollisionDetector().getType() == detector
    world.step()
    assert min(row[8] for row in world.contacts()) == pytest.approx(-1e-3, abs=1e-9)
