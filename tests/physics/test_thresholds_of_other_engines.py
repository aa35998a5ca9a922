"""Speeds that an engine's law knows, and Coulomb's and Newton's do not.

An engine that cuts a speed off without a word would have another initial state after its first step
than before it, where it is read back; adapters lift such limits. Impacts that give nothing back are
part of an engine's law and stay.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.peers.catalogue import PEERS, peer_of
from lavendersim.peers.description import Scene
from tests.engines import needs

FLIGHT = """
scene:
  gravity: [0, 0, 0]
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0], velocity: [2000, 0, 0],
           angular_velocity: [0, 0, 2000]}
numerics: {timestep: 1/1000}
duration: 1
"""
# Slower than any engine's threshold of sleep, for longer than any waits (2 s of Rapier and Bullet).
SLOW = """
scene:
  gravity: [0, 0, 0]
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0],
           velocity: [0.001, 0, 0]}
numerics: {timestep: 1/60}
duration: 5
"""
IMPACT = """
scene:
  gravity: [0, 0, 0]
  surfaces: {{rubber: {{restitution: 0.5}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: rubber}}
    ball: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1, position: [0, 0, {height}],
           velocity: [0, 0, -{speed}], surface: rubber}}
numerics: {{timestep: 1/1000}}
duration: 1
"""
ENGINES = [pytest.param(name, marks=needs(name)) for name in PEERS]


def world_of(text: str, engine: str) -> Any:
    scene = Scene(load_experiment_text(text, "s.yaml").cells()[0].config)
    peer = peer_of(engine)
    made: Any = import_module(f"lavendersim.peers.adapters.{peer.name}")
    return made.World(scene, peer.variants[engine].settings)


@pytest.mark.parametrize("name", ENGINES)
def test_no_speed_is_cut_off(name: str) -> None:
    """A ball in flight keeps 2000 m/s and 2000 rad/s: 24 bits, through a root a step."""
    for variant in PEERS[name].variants:
        world = world_of(FLIGHT, variant)
        for _ in range(5):
            world.step()
        assert world.velocities()[0] == pytest.approx([2000, 0, 0, 0, 0, 2000], rel=1e-5), variant


@pytest.mark.parametrize("name", ENGINES)
def test_nothing_falls_asleep(name: str) -> None:
    """A ball glides on at 1 mm/s for 5 s: 300 sums of 24 bits, each 2^-24 of 5 mm off at most."""
    for variant in PEERS[name].variants:
        world = world_of(SLOW, variant)
        for _ in range(300):
            world.step()
        assert world.velocities()[0] == pytest.approx([1e-3, 0, 0, 0, 0, 0], rel=2**-23), variant
        assert world.poses()[0][0] == pytest.approx(5e-3, rel=300 * 2**-24), variant


@pytest.mark.parametrize(
    ("engine", "speed", "rebound"),
    [
        # rebounds of 0.1 m/s and less are none, those above 100 m/s are 100 m/s
        pytest.param("dart", 0.19, 0.0, marks=needs("dart")),
        pytest.param("dart", 0.21, 0.105, marks=needs("dart")),
        pytest.param("dart", 400.0, 100.0, marks=needs("dart")),
        # impacts of 2 m/s and less give nothing back; of the tuned one, 0.01 m/s
        pytest.param("physx", 1.95, 0.0, marks=needs("physx")),
        pytest.param("physx", 2.05, 1.025, marks=needs("physx")),
        pytest.param("physx-accurate", 1.95, 0.975, marks=needs("physx")),
        pytest.param("rapier", 0.01, 0.005, marks=needs("rapier")),
    ],
)
def test_which_impacts_give_back_what_restitution_says(
    engine: str, speed: float, rebound: float
) -> None:
    """It meets the floor in the tenth step, at e = 0.5. DART pushes penetration out by up to its
    0.1 m/s, of which it leaves 1 mm/s here; 3e-5 of the speed is its regularisation.
    """
    world = world_of(IMPACT.format(speed=speed, height=0.1 + 0.0095 * speed), engine)
    for _ in range(60):
        world.step()
    assert world.velocities()[0, 2] == pytest.approx(rebound, rel=1e-4, abs=2e-3)
