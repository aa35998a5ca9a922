"""Poses without a direction of their own, extreme sizes and far origins give true manifolds."""

from __future__ import annotations

import convex
import numpy as np
import poses
import pytest

from lavendersim.engine.records import TOUCHING


def box_pair(boxes):
    first, second = poses.allocate(len(boxes)), poses.allocate(len(boxes))
    for i, (a, b) in enumerate(boxes):
        poses.put(first[i], a.half, a.centre, a.matrix)
        poses.put(second[i], b.half, b.centre, b.matrix)
    return poses.manifolds("box_box", first, second)


def one(pair, half_a, half_b, centre_b, centre_a=(0.0, 0.0, 0.0)):
    first, second = poses.allocate(1), poses.allocate(1)
    poses.put(first[0], half_a, centre_a)
    poses.put(second[0], half_b, centre_b)
    return poses.manifolds(pair, first, second)[0]


def small_turn(rng, low, high):
    axis = rng.normal(size=3)
    angle = 10.0 ** rng.uniform(low, high)
    axis *= np.sin(0.5 * angle) / np.linalg.norm(axis)
    return convex.matrix_of(np.array([np.cos(0.5 * angle), *axis]))


@pytest.mark.parametrize("distance", [0.0, 1e-320, 1e-160])
@pytest.mark.parametrize("pair", ["sphere_sphere", "box_box"])
def test_coincident_centres_are_pushed_apart_by_their_full_depth(pair, distance):
    half = [0.5] if pair == "sphere_sphere" else [0.5, 0.4, 0.3]
    manifold = one(pair, half, half, (distance, 0.0, 0.0))
    assert np.linalg.norm(manifold.normal) == pytest.approx(1.0, abs=1e-15)
    assert manifold.phi.min() == pytest.approx(-2.0 * half[-1], abs=1e-15)


@pytest.mark.parametrize("centre", [(0.1, 0.0, 0.25), (0.0, 0.0, 0.0), (0.0, 0.0, 0.3)])
def test_sphere_with_its_centre_in_the_box_leaves_through_the_nearest_face(centre):
    manifold = one("sphere_box", [0.5, 0.4, 0.3], [0.1], centre)
    np.testing.assert_array_equal(manifold.normal, [0.0, 0.0, 1.0])
    assert manifold.phi[0] == pytest.approx(centre[2] - 0.3 - 0.1, abs=1e-15)


def test_sphere_that_sinks_through_a_face_sees_no_jump_of_depth_or_normal():
    """Either side of the face the separation is z - h - r; nearer than one ulp of h on both."""
    for z in (0.3 - 1e-16, 0.3, 0.3 + 1e-16, 0.3 + 1e-12):
        manifold = one("sphere_box", [0.5, 0.4, 0.3], [0.1], (0.2, 0.1, z))
        np.testing.assert_array_equal(manifold.normal, [0.0, 0.0, 1.0])
        assert manifold.phi[0] == pytest.approx(z - 0.4, abs=1e-15)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_flush_faces_touch_in_the_four_corners_of_their_overlap(scale):
    half = np.array([0.5, 0.5, 0.5]) * scale
    manifold = one("box_box", half, half, (0.25 * scale, 0.125 * scale, scale))
    assert len(manifold.phi) == 4
    corners = {(round(x / scale, 6), round(y / scale, 6)) for x, y, _ in manifold.points}
    assert corners == {(-0.25, -0.375), (0.5, -0.375), (0.5, 0.5), (-0.25, 0.5)}
    np.testing.assert_allclose(manifold.phi, 0.0, atol=1e-15 * scale)
    np.testing.assert_array_equal(manifold.normal, [0.0, 0.0, 1.0])


def test_crossed_edges_touch_in_one_point_between_them():
    """Two unit cubes on edge, crossed at right angles: their edges are 2 sqrt(1/2) m apart in z."""
    turn_x = convex.matrix_of(np.array([np.cos(np.pi / 8), np.sin(np.pi / 8), 0.0, 0.0]))
    turn_y = convex.matrix_of(np.array([np.cos(np.pi / 8), 0.0, np.sin(np.pi / 8), 0.0]))
    height = 2.0 * np.sqrt(0.5) - 0.01
    a = convex.Box(np.zeros(3), turn_x, np.full(3, 0.5))
    b = convex.Box(np.array([0.1, -0.2, height]), turn_y, np.full(3, 0.5))
    manifold = box_pair([(a, b)])[0]
    assert len(manifold.phi) == 1
    assert manifold.phi[0] == pytest.approx(-0.01, abs=1e-14)
    np.testing.assert_allclose(manifold.normal, [0.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(manifold.points[0], [0.1, 0.0, 0.5 * height], atol=1e-14)


ATTACKS = {
    # log10 of half edges, distance of the origin, log10 of the turn between nearly flush boxes
    "sizes 1e-3 to 1e3": ((-3.0, 3.0), 0.0, None),
    "origin at 1e5": ((-1.0, 0.0), 1e5, None),
    "nearly flush": ((-1.0, 0.0), 0.0, (-16.0, -1.0)),
    "nearly flush, 1 km": ((2.0, 3.0), 0.0, (-7.0, -4.0)),
    "nearly flush, origin at 1e5": ((-1.0, 0.0), 1e5, (-9.0, -1.0)),
}


@pytest.mark.parametrize("name", ATTACKS)
def test_overlap_is_always_seen_and_its_surfaces_are_true(name, rng):
    sizes, origin, turn = ATTACKS[name]
    boxes = []
    for i in range(1000):
        half_a, half_b = 10.0 ** rng.uniform(*sizes, (2, 3))
        matrix = convex.random_rotation(rng)
        if turn is None:
            offset = rng.normal(size=3)
            offset *= (
                rng.uniform(0.0, 1.0) * np.linalg.norm(half_a + half_b) / np.linalg.norm(offset)
            )
            other = convex.random_rotation(rng)
        else:
            offset = rng.uniform(-0.9, 0.9, 3) * (half_a + half_b)
            face = i % 3
            offset[face] = (half_a + half_b)[face] * (1.0 - 1e-6 * rng.uniform(-1.0, 1.0))
            other = matrix @ small_turn(rng, *turn)
            offset = matrix @ offset
        centre = rng.normal(size=3) * origin
        a, b = convex.Box(centre, matrix, half_a), convex.Box(centre + offset, other, half_b)
        boxes.append((a, b))
    overlapping = 0
    for (a, b), manifold in zip(boxes, box_pair(boxes), strict=True):
        # A few hundred roundings of coordinates; edges that are nearly parallel lose up to 1e3.
        size = max(a.half.max(), b.half.max())
        slack = 1e-12 * size + 1e-15 * 10.0 * max(origin, 1.0)
        separation = convex.box_box_separation(a, b)
        overlapping += separation < -slack
        if separation < -slack:
            assert len(manifold.phi)
        if separation > TOUCHING + slack:
            assert not len(manifold.phi)
        for point, phi in zip(manifold.points, manifold.phi, strict=True):
            assert np.isfinite(point).all()
            half = 0.5 * phi * manifold.normal
            assert convex.depth_in_box(a, point - half) <= 1.5 * TOUCHING + slack
            assert convex.depth_in_box(b, point + half) <= 1.5 * TOUCHING + slack
    assert overlapping > 80
