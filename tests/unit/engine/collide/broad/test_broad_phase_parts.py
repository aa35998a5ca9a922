"""Parts of a compound pair by the motion and the mass of their owner, and never with each other."""

from __future__ import annotations

import numpy as np
import pytest
from broad_phase_scenes import World, disturb, random_world

from lavendersim.engine.records import COMPOUND, PLANE, SPHERE


def test_parts_of_one_body_never_pair_and_move_with_their_owner():
    """Two dumb-bells of two spheres; parts have no inverse mass of their own and lie 2 m apart."""
    world = World(6, "compound")
    for body, x in enumerate((0.0, 10.0)):
        world.put(body, COMPOUND, (), (x, 0.0, 0.0))
        world.bodies["bound"][body] = 2.1
        for part, side in enumerate((-1.0, 1.0)):
            row = 2 + 2 * body + part
            world.put(row, SPHERE, (1.05,), (x + side, 0.0, 0.0))
            world.bodies["owner"][row], world.bodies["inv_m"][row] = body, 0.0
    assert len(world.listed()) == 0
    # Parts of the two are 10 - 2 - 2.1 = 5.9 m apart; a spin carries the first's |omega| 2.1 dt.
    world.velocities["wz"][0] = 5.9 / 2.1 * 240.0 * 1.01
    assert world.needed() == {3 * 6 + 4}
    assert set(world.listed()["key"].tolist()) >= world.needed()
    world.bodies["inv_m"][:2] = 0.0
    assert world.needed() == set()
    world.work.state["listed"] = 0
    assert len(world.listed()) == 0


@pytest.mark.parametrize("scene", range(10))
def test_no_pair_of_parts_is_ever_missing(scene):
    rng = np.random.default_rng([8, scene])
    world = random_world(rng, "compound")
    shapes = world.bodies["shape"]
    bodies = np.flatnonzero(shapes != PLANE)
    owners, parts = bodies[: len(bodies) // 4], bodies[len(bodies) // 4 :]
    for owner in owners:
        world.bodies["shape"][owner], world.bodies["material"][owner] = COMPOUND, 0
    for part in parts[: 3 * len(owners)]:
        owner = rng.choice(owners)
        world.bodies["owner"][part], world.bodies["inv_m"][part] = owner, 0.0
        world.bodies["bound"][owner] = max(
            world.bodies["bound"][owner], 2.0 * world.bodies["bound"][part]
        )
    for _ in range(8):
        assert not world.needed() - set(world.listed()["key"].tolist())
        world.move(float(world.parameters["dt"][0]))
        disturb(world, rng)
