"""No pair that may come near is ever missing, and a list that serves is not made again."""

from __future__ import annotations

from itertools import permutations

import convex
import numpy as np
import pytest
from broad_phase_scenes import World, disturb, half_extents, packed, random_world

from lavendersim.engine.records import BOX, CAPSULE, CYLINDER, PLANE, SPHERE, TOUCHING


@pytest.mark.parametrize("shape", [BOX, CAPSULE, CYLINDER])
def test_the_box_around_a_body_is_its_least(shape):
    """Of a rim's 720 points the farthest is within r (1 - cos(pi/720)) = 1e-5 r of the true one."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        world = World(1, gravity=0.0)
        half = rng.uniform(0.1, 1.0, 3)
        if shape != BOX:
            half[1] = 0.0
        world.put(0, shape, half, (0.0, 0.0, 0.0), convex.random_rotation(rng))
        world.listed()
        fat = world.work.fat_bounds[0]  # at rest and without gravity it is not grown
        found = np.array([fat[name] for name in ("ex", "ey", "ez")]) - TOUCHING
        np.testing.assert_allclose(found, half_extents(world.bodies[0]), rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("scene", range(40))
def test_no_pair_within_reach_is_ever_missing(scene):
    rng = np.random.default_rng([7, scene])
    world = random_world(rng)
    needed = 0
    for _ in range(12):
        must = world.needed()
        assert not must - set(world.listed()["key"].tolist())
        needed += len(must)
        world.move(float(world.parameters["dt"][0]))
        disturb(world, rng)
    assert needed > 0 or len(world.bodies) < 40


def test_rows_ascend_name_their_bodies_and_carry_the_template():
    rng = np.random.default_rng(3)
    for _ in range(10):
        world = random_world(rng)
        rows, count, b = world.listed(), len(world.bodies), world.bodies
        assert (np.diff(rows["key"]) > 0).all()
        first, second = rows["key"] // count, rows["key"] % count
        assert (first < second).all()
        template = world.templates[b["material"][first], b["material"][second]]
        swapped = template["swap"] == 1
        np.testing.assert_array_equal(rows["a"], np.where(swapped, second, first))
        np.testing.assert_array_equal(rows["b"], np.where(swapped, first, second))
        for name in ("kind", "friction", "restitution"):
            np.testing.assert_array_equal(rows[name], template[name])
        assert (template["kind"] >= 0).all()
        assert ((b["inv_m"][first] > 0.0) | (b["inv_m"][second] > 0.0)).all()


def test_too_few_rows_are_refused_and_enough_give_the_same_list():
    world = packed(4)
    rows = world.listed().copy()
    assert world.failures == 1  # what it asked for then was enough
    assert world.work.state["needed"][0] == len(rows) == len(world.pairs) > 16
    world.make_room(10 * len(rows))
    np.testing.assert_array_equal(world.listed(), rows)


def test_a_settled_pile_lists_its_neighbours_and_is_listed_once():
    """The lattice has 3 n^2 (n - 1) touching pairs and n^2 on the plane. Next neighbours lie
    (sqrt 2 - 1) 2 r = 41 mm apart, far beyond reach and slack (3 mm): nothing else is listed."""
    world, n = packed(6), 6
    rng = np.random.default_rng(1)
    for _ in range(300):
        assert len(world.listed()) == 3 * n * n * (n - 1) + n * n
        for axis in "xyz":
            world.velocities[f"v{axis}"] = rng.normal(size=len(world.bodies)) * 1e-3
    assert world.rebuilds == 1


def test_a_list_is_made_anew_for_a_body_that_moved_turned_or_was_thrown():
    def moved(world):
        world.bodies["x"][2] += 0.01

    def turned(world):
        world.turn(1, convex.random_rotation(np.random.default_rng(4)))

    def thrown(world):
        world.velocities["vy"][1] = 3.0

    def spun(world):
        world.velocities["wx"][1] = 300.0

    def slowed(world):
        world.parameters["dt"] *= 10.0

    for change in (moved, turned, thrown, spun, slowed):
        world = World(3)
        world.put(0, PLANE, (0.0, 0.0, 1.0))
        world.put(1, BOX, (0.1, 0.01, 0.01), (0.0, 0.0, 0.3))
        world.put(2, SPHERE, (0.1,), (0.0, 0.35, 0.3))
        world.bodies["inv_m"][0] = 0.0
        world.listed()
        world.listed()
        assert world.rebuilds == 1
        change(world)
        world.listed()
        assert world.rebuilds == 2, change.__name__
        world.listed()
        assert world.rebuilds == 2, change.__name__


@pytest.mark.parametrize(("along", "towards"), list(permutations(range(3), 2)))
def test_a_rod_that_is_turned_meets_what_its_end_now_reaches(along, towards):
    """Turned about its centre: no sphere sees it, and its box grows along one axis alone."""
    axes = np.eye(3)
    world = World(2)
    world.put(0, BOX, np.where(axes[along] > 0.0, 0.1, 0.01))
    world.put(1, SPHERE, (0.01,), 0.1099 * axes[towards])
    assert len(world.listed()) == 0
    turned = axes.copy()
    turned[:, along], turned[:, towards] = axes[towards], -axes[along]
    world.turn(0, turned)
    assert len(world.listed()) == len(world.needed()) == 1


def test_spheres_that_approach_along_a_diagonal_are_not_missed():
    """Reach 0.34 mm, slack 8 times that: at 206.2 mm not listed, and 2.7 mm along each of three
    axes stay within the boxes but bring both 4.7 mm nearer, to an overlap."""
    world, diagonal = World(2), np.ones(3) / np.sqrt(3.0)
    world.put(0, SPHERE, (0.1,))
    world.put(1, SPHERE, (0.1,), 0.2062 * diagonal)
    assert len(world.listed()) == 0
    for axis in "xyz":
        world.bodies[axis] += (0.0027, -0.0027)
    assert len(world.listed()) == len(world.needed()) == 1


def test_few_fast_bodies_are_followed_and_do_not_renew_the_list_every_step():
    """One of 217 flies 1 m a step beside the pile; the list made in a step lasts STEPS = 8 more."""
    world = packed(6)
    world.bodies["x"][1], world.velocities["vx"][1] = 5.0, 240.0
    for _ in range(80):
        world.listed()
        world.move(1.0 / 240.0)
    assert world.rebuilds == np.ceil(80 / 9)


def test_bodies_that_nothing_can_push_make_no_pair_wherever_they_are():
    world = World(20)
    for i in range(20):
        world.put(i, BOX, (1.0, 1.0, 1.0))
    world.bodies["inv_m"] = 0.0
    world.velocities["vx"][:5] = 3.0  # kinematic
    assert len(world.listed()) == 0
