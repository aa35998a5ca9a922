"""Rapier has what it was given before its first step, and mixes surfaces as lavender does."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS
from lavendersim.peers.child import misbuilt
from lavendersim.peers.description import Scene
from tests.engines import BALL, BOX, needs

pytestmark = needs("rapier")


@pytest.mark.parametrize("text", [BALL, BOX])
def test_a_scene_is_built_as_described(text: str) -> None:
    from lavendersim.peers.adapters.rapier import World

    scene = Scene(load_experiment_text(text, "scene").cells()[0].config)
    assert (
        misbuilt(
            scene, World(scene, PEERS["rapier"].variants["rapier-stiff"].settings), PEERS["rapier"]
        )
        == ""
    )


def test_a_push_lasts_until_it_is_taken_back() -> None:
    """2 kg pushed by 4 N for one step of 0.01 s: 0.02 m/s, and no more in the next step."""
    import numpy as np

    from lavendersim.peers.adapters.rapier import World

    scene = Scene(load_experiment_text(BALL, "scene").cells()[0].config)
    world = World(scene, {})
    for loads in (np.array([[0.0, 4.0, 0.0, 0.0, 0.0, 0.0]]), np.zeros((1, 6))):
        world.push(loads)
        world.step()
        assert world.velocities()[0, 1] == pytest.approx(0.02, rel=1e-6)
