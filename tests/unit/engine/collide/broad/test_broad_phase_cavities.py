"""All that can move, and nothing else, is a pair of each cavity, wherever it is."""

from __future__ import annotations

import numpy as np
import pytest
from broad_phase_scenes import WITH_CAVITIES, World, disturb, random_world

from lavendersim.engine.records import BOWL, DRUM, SPHERE

CAVITIES = (BOWL, DRUM)


def around(world: World, rng: np.random.Generator) -> World:
    """Put a bowl and a drum, narrower and wider than where the bodies are, in any two rows."""
    for shape, row in zip(CAVITIES, rng.choice(len(world.bodies), 2, replace=False), strict=True):
        radius = 10.0 ** rng.uniform(-2.0, 3.0)
        world.put(row, shape, (radius, 0.0, 0.0), rng.normal(size=3))
        world.bodies["inv_m"][row] = 0.0
    return world


@pytest.mark.parametrize("scene", range(10))
def test_no_pair_is_missing_among_bodies_in_cavities(scene):
    rng = np.random.default_rng([11, scene])
    world = around(random_world(rng, pairs=WITH_CAVITIES), rng)
    for _ in range(6):
        must, keys = world.needed(), world.listed()["key"]
        assert (np.diff(keys) > 0).all()
        assert not must - set(keys.tolist())
        world.move(float(world.parameters["dt"][0]))
        disturb(world, rng)


@pytest.mark.parametrize("shape", CAVITIES)
def test_each_ball_is_a_pair_of_its_cavity_and_of_no_other_ball(shape):
    """Balls far apart, one beyond the wall, one fixed: a cavity is no leaf that others may meet."""
    world = World(6, pairs=WITH_CAVITIES)
    for row in range(5):
        world.put(row, SPHERE, (0.1,), (float(row), 0.0, 0.0))
    world.put(5, shape, (3.5, 0.0, 0.0))
    world.bodies["inv_m"][[2, 5]] = 0.0
    world.velocities["wz"][5] = 100.0  # it turns
    rows = world.listed()
    assert rows["key"].tolist() == [6 * ball + 5 for ball in (0, 1, 3, 4)]
    world.listed()
    assert world.rebuilds == 1


def test_a_ball_that_leaves_its_bounds_keeps_its_pair_with_the_cavity():
    world = World(2, pairs=WITH_CAVITIES)
    world.put(0, BOWL, (3.0, 0.0, 0.0))
    world.put(1, SPHERE, (0.1,))
    world.bodies["inv_m"][0] = 0.0
    for _ in range(3):
        assert world.listed()["key"].tolist() == [1]
        world.bodies["x"][1] += 1.0
    assert world.rebuilds == 3
