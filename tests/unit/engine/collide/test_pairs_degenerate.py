"""Bodies in one place, shapes without length and contacts metres ahead give finite, true manifolds.

A normal proves itself: no direction has a depth less than the true one, so the depth along a normal
that is as deep as the least of many directions is the least (solids.py).
"""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solid_poses
import solids

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.convex.hull_geometry import UNIT_BOX, hull_geometry
from lavendersim.engine.collide.manifold.polygon_clip import HalfPlane, cut_straight
from lavendersim.engine.collide.scratch import allocate_scratch
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.records import POINT, TOUCHING, dtype

HALF = (0.3, 0.3, 0.4)
HULL = (0.4 * UNIT_BOX[0], [list(loop) for loop in UNIT_BOX[1]])
MOVABLE = [name for name in solid_poses.PAIRS if "plane" not in name]
# EPA of a round core stops at 1e-5 of the sizes and 1e-3 of the depth, before `ascend` (epa.py).
ROUND = 1e-3


def pair_of(name: str, offset, turn=None, half=HALF) -> solid_poses.Sample:
    rows = [allocate_bodies(solid_poses.EVERY_SHAPE, 1) for _ in range(2)]
    for row, kind, centre, matrix in zip(
        rows, SHAPE_PAIRS[name].shapes, (np.zeros(3), offset), (None, turn), strict=True
    ):
        solid_poses.put(row[0], kind, half, centre, matrix, corners=HULL[0])
    return solid_poses.Sample(name, rows[0], rows[1], [HULL])


def is_sound(manifold) -> bool:
    return (
        1 <= len(manifold.phi) <= 4
        and bool(np.isfinite(manifold.points).all() and np.isfinite(manifold.phi).all())
        and abs(float(np.linalg.norm(manifold.normal)) - 1.0) < 4e-15
    )


@pytest.mark.parametrize("distance", [0.0, 1e-300, 1e-17])
@pytest.mark.parametrize("name", MOVABLE)
def test_bodies_in_one_place_are_parted_by_their_least_depth(name, distance, rng):
    for turn in (np.eye(3), convex.random_rotation(rng)):
        sample = pair_of(name, (distance, 0.0, distance), turn)
        manifold = solid_poses.manifolds(sample, TOUCHING)[0]
        assert is_sound(manifold)
        directions = rng.normal(size=(2000, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        a, b = sample.solids(0)
        best = max(solids.separation_along(a, b, n) for n in directions)
        own = solids.separation_along(a, b, manifold.normal)
        assert own >= best - ROUND * abs(best)
        # An edge pair of boxes is kept as a face while that is 5 % and 5 mm of a metre deeper.
        assert manifold.phi.min() == pytest.approx(own, rel=0.01, abs=1e-6)


# Beside a cone what is round is nearest to it across its side, which leans.
ACROSS = ("sphere_cone", "ellipsoid_cone")
APART = [(name, axis) for name in MOVABLE for axis in range(3) if name not in ACROSS or axis == 2]


@pytest.mark.parametrize(("name", "axis"), APART)
def test_parallel_bodies_metres_apart_have_their_true_distance(name, axis):
    offset = np.zeros(3)
    offset[axis] = 4.0
    sample = pair_of(name, offset)
    manifold = solid_poses.manifolds(sample, 5.0)[0]
    assert is_sound(manifold)
    a, b = sample.solids(0)
    # The axis is the direction of the nearest points of all these shapes.
    direction = offset / 4.0
    np.testing.assert_allclose(manifold.normal, direction, atol=1e-9)
    assert manifold.phi.min() == pytest.approx(
        solids.separation_along(a, b, direction), abs=2.0 * TOUCHING
    )


@pytest.mark.parametrize(
    "name", [name for name in solid_poses.PAIRS if "capsule" in name and "cone" not in name]
)
def test_a_capsule_without_length_is_a_sphere(name):
    half = (0.3, 0.3, 0.0)
    kinds = SHAPE_PAIRS[name].shapes
    for turn in (np.eye(3), convex.matrix_of([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])):
        rows = [allocate_bodies(solid_poses.EVERY_SHAPE, 1) for _ in range(2)]
        for row, kind, z in zip(rows, kinds, (0.0, 0.7 - 1e-6), strict=True):
            size = half if kind == "capsule" else (0.3, 0.3, 0.4)
            if kind == "plane":
                solid_poses.put(row[0], kind, (0.0, 0.0, 1.0), offset=0.4)
                continue
            solid_poses.put(row[0], kind, size, (0.0, 0.0, z), turn, corners=HULL[0])
        sample = solid_poses.Sample(name, rows[0], rows[1], [HULL])
        manifold = solid_poses.manifolds(sample, 1.0)[0]
        assert is_sound(manifold)
        if kinds[0] != "plane":
            assert len(manifold.phi) == 1  # not two in one place
        a, b = sample.solids(0)
        up = np.array([0.0, 0.0, 1.0])
        np.testing.assert_allclose(manifold.normal, up, atol=1e-9)
        assert manifold.phi.min() == pytest.approx(
            solids.separation_along(a, b, up), abs=2.0 * TOUCHING
        )


def test_a_polygon_whose_corners_alternate_about_a_cut_stays_in_its_rows():
    """Every second corner is out: each adds one, and half of the rows is all there is."""
    room = len(allocate_scratch(hull_geometry()).polygon)
    rows = np.zeros(2 * room, dtype(POINT))
    half = room // 2
    rows["x"][:half] = np.where(np.arange(half) % 2 == 0, -1e-17, 1e-17)
    rows["y"][:half] = np.arange(half)
    rows["feature"] = -1
    kept = cut_straight(rows[:room], 0, half, HalfPlane(1.0, 0.0, 0.0), 0)
    assert half - 2 <= kept <= half
    assert (rows["feature"][room:] == -1).all()
