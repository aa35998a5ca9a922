"""The manifold of any two convex bodies: its least gap is proved, and faces rest on faces."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from scipy.optimize import minimize_scalar
from single_bodies import body, manifold, solid

from lavendersim.engine.collide.convex.hull_geometry import UNIT_BOX
from lavendersim.engine.collide.pairs.convex import NEAREST

CUBE = (0.5 * UNIT_BOX[0], [list(loop) for loop in UNIT_BOX[1]])


def cube(centre, matrix) -> np.ndarray:
    return body("hull", (1.0, 1.0, 1.0), centre, matrix, corners=CUBE[0])


def test_a_capsule_is_as_far_from_a_box_as_the_nearest_point_of_its_axis(rng) -> None:
    """The distance to a box is convex along the axis: a search without derivatives finds it."""
    apart = 0
    for _ in range(40):
        a = body("box", rng.uniform(0.2, 0.5, 3), rng.normal(size=3), convex.random_rotation(rng))
        shape = solid(a)
        place = shape.centre + 0.8 * rng.normal(size=3)
        b = body("capsule", (0.1, 0.0, 0.4), place, convex.random_rotation(rng))
        axis = solid(b).matrix[:, 2]

        def distance(s, place=place, axis=axis, shape=shape):
            return solids.off_surface(shape, place + s * axis)

        found = minimize_scalar(
            distance, bounds=(-0.4, 0.4), method="bounded", options={"xatol": 1e-10}
        )
        least = min(found.fun, distance(-0.4), distance(0.4))
        if least < 1e-3:
            continue
        apart += 1
        seen = manifold("capsule_box", a, b, 10.0)
        # a corner of the patch within TOUCHING is taken for the nearest point
        assert seen.phi.min() == pytest.approx(least - 0.1, abs=3e-9)
        assert np.linalg.norm(seen.normal) == pytest.approx(1.0, abs=1e-14)
        assert solids.separation_along(solid(a), solid(b), seen.normal) == pytest.approx(
            least - 0.1, abs=1e-9
        )
        for phi, point in zip(seen.phi, seen.points, strict=True):
            on_a = point - 0.5 * phi * seen.normal
            assert solids.off_surface(shape, on_a) == pytest.approx(0.0, abs=1e-8)
    assert apart > 15


@pytest.mark.parametrize("depth", [0.01, -0.01])
def test_a_cube_on_a_cube_touches_in_the_corners_of_the_overlap(depth: float, rng) -> None:
    world, start = convex.random_rotation(rng), rng.normal(size=3)
    a = cube(start, world)
    shift = np.array([0.3, 0.2, 1.0 - depth])
    b = cube(start + world @ shift, world)
    found = manifold("hull_hull", a, b, 0.02, [CUBE])
    np.testing.assert_allclose(found.normal, world[:, 2], atol=1e-12)
    np.testing.assert_allclose(found.phi, -depth, atol=1e-8)
    local = (found.points - start) @ world
    corners = {(round(x, 6), round(y, 6)) for x, y, _ in local}
    assert corners == {(-0.2, -0.3), (0.5, -0.3), (0.5, 0.5), (-0.2, 0.5)}
    np.testing.assert_allclose(local[:, 2], 0.5 - 0.5 * depth, atol=1e-8)


def test_a_corner_over_a_face_touches_by_the_nearest_points(rng) -> None:
    """A cube on its corner, sqrt(3)/2 below its centre: no feature of it looks along n."""
    world = convex.random_rotation(rng)
    down = np.linalg.qr(np.column_stack([np.ones(3), [1, -1, 0], [1, 1, -2]]))[0]
    down *= np.sign(down[:, 0] @ np.ones(3)) * np.array([1, 1, 1])
    turn = np.column_stack([down[:, 1], down[:, 2], down[:, 0]]).T  # the diagonal along z
    if np.linalg.det(turn) < 0.0:
        turn[0] *= -1.0
    a = body("box", (1.0, 1.0, 0.5), matrix=world)
    height = 0.5 + np.sqrt(0.75)
    b = cube(world @ [0.1, 0.2, height + 0.03], world @ turn)
    found = manifold("hull_box", a, b, 0.1, [CUBE])
    assert found.feature.tolist() == [NEAREST]
    assert found.phi == pytest.approx([0.03], abs=1e-12)
    np.testing.assert_allclose(found.points[0] @ world, (0.1, 0.2, 0.515), atol=1e-12)


def test_two_lying_cylinders_touch_along_their_sides(rng) -> None:
    world = convex.random_rotation(rng)
    a = body("cylinder", (0.3, 0.0, 0.5), matrix=world)
    b = body("cylinder", (0.2, 0.0, 0.4), world @ [0.0, 0.499, 0.3], world)
    found = manifold("cylinder_cylinder", a, b)
    np.testing.assert_allclose(found.normal, world[:, 1], atol=1e-12)
    np.testing.assert_allclose(found.phi, -1e-3, atol=1e-12)
    local = found.points @ world
    np.testing.assert_allclose(np.sort(local[:, 2]), [-0.1, 0.5], atol=1e-9)
    np.testing.assert_allclose(local[:, 1], 0.2995, atol=1e-12)


def test_what_is_beyond_the_margin_or_the_bounding_spheres_has_no_point() -> None:
    a = body("box", (0.5, 0.5, 0.5))
    for gap, count in ((0.009, 2), (0.011, 0), (50.0, 0)):
        b = body("cylinder", (0.3, 0.0, 0.4), (0.0, 0.8 + gap, 0.0))
        assert len(manifold("cylinder_box", a, b, 0.01).phi) == count
