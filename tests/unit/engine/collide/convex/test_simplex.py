"""The point of a simplex nearest to the origin, by trying every face of it in numpy."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from interpreted import interpreted, records

from lavendersim.engine.collide.convex import simplex
from lavendersim.engine.collide.records import VERTEX
from lavendersim.engine.records import dtype
from lavendersim.engine.vectors import Vec3

segment, triangle, nearest, drop, away = (
    interpreted(one)
    for one in (
        simplex.nearest_on_segment,
        simplex.nearest_on_triangle,
        simplex.nearest_on_simplex,
        simplex.drop_weightless,
        simplex.faces_away,
    )
)
GRAIN = 1e-15


def brute(points: np.ndarray) -> np.ndarray:
    """Return the nearest of the feet on all points, lines, planes (and space) that lie within."""
    best = None
    for size in range(1, len(points) + 1):
        for chosen in combinations(range(len(points)), size):
            p = points[list(chosen)]
            # Weights w: sum 1, and the foot is normal to the flat: p0 + E t with E^T (p0 + E t) = 0
            edges = (p[1:] - p[0]).T
            t = np.linalg.lstsq(edges, -p[0], rcond=None)[0] if size > 1 else np.zeros(0)
            weights = np.array([1.0 - t.sum(), *t])
            foot = weights @ p
            if weights.min() >= -1e-12 and (best is None or foot @ foot < best @ best):
                best = foot
    return best


def vertices(points) -> np.ndarray:
    rows = np.zeros(5, dtype(VERTEX))
    for axis, values in zip("xyz", np.transpose(points), strict=True):
        rows[axis][: len(points)] = values
    rows["ax"] = np.arange(5)
    return rows


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_the_point_is_the_nearest_and_the_weights_make_it(count: int, rng) -> None:
    """Simplices around, beside and far from the origin; round-off of lengths of some metres."""
    inside = 0
    for _ in range(150):
        points = rng.normal(size=(count, 3)) + rng.normal(size=3) * rng.choice([0.0, 0.5, 3.0])
        rows, weights = vertices(points), np.zeros(4)
        found, point = nearest(records(rows), count, weights, GRAIN)
        expected = brute(points)
        if found:
            inside += 1
            assert count == 4
            np.testing.assert_allclose(expected, 0.0, atol=1e-12)
            continue
        np.testing.assert_allclose(point, expected, atol=1e-12)
        assert weights[:count].min() >= 0.0
        assert weights[:count].sum() == pytest.approx(1.0, abs=1e-12)
        np.testing.assert_allclose(weights[:count] @ points, point, atol=1e-12)
    assert (inside > 4) is (count == 4)


def test_a_segment_ends_at_its_ends_and_may_be_a_point() -> None:
    p, q = Vec3(1.0, 1.0, 0.0), Vec3(-3.0, 1.0, 0.0)
    assert segment(p, q) == (Vec3(0.0, 1.0, 0.0), 0.75, 0.25)
    assert segment(q, p) == (Vec3(0.0, 1.0, 0.0), 0.25, 0.75)
    far = Vec3(5.0, 1.0, 0.0)
    assert segment(p, far) == (p, 1.0, 0.0)
    assert segment(far, p) == (p, 0.0, 1.0)
    assert segment(p, p) == (p, 1.0, 0.0)


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)])
def test_a_flat_triangle_is_its_edges(order) -> None:
    """Three points of a line: nearest is (0, 2, 0), in the piece that holds it."""
    points = np.array([[-1.0, 2.0, 0.0], [0.5, 2.0, 0.0], [3.0, 2.0, 0.0]])[list(order)]
    found = triangle(*(Vec3(*p) for p in points))
    np.testing.assert_allclose(found.point, (0.0, 2.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(np.array(found[1:]) @ points, found.point, atol=1e-15)


def test_a_tetrahedron_thinner_than_the_grain_holds_nothing() -> None:
    """Its faces all count, whichever side round-off puts the fourth corner on."""
    points = np.array([[1.0, 0.0, 1e-17], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [0.1, 0.0, -1e-17]])
    inside, point = nearest(records(vertices(points)), 4, np.zeros(4), GRAIN)
    assert not inside
    np.testing.assert_allclose(point, 0.0, atol=1e-16)
    corners = [Vec3(*p) for p in points]
    assert away(*corners, GRAIN)


def test_a_face_parts_the_origin_from_the_opposite_corner() -> None:
    p, q, r = Vec3(1.0, 0.0, 1.0), Vec3(-1.0, 1.0, 1.0), Vec3(-1.0, -1.0, 1.0)
    assert away(p, q, r, Vec3(0.0, 0.0, 2.0), GRAIN)
    assert not away(p, q, r, Vec3(0.0, 0.0, -2.0), GRAIN)
    assert not away(p, r, q, Vec3(0.0, 0.0, 0.5), GRAIN)
    assert away(p, r, q, Vec3(0.0, 0.0, 0.5), 0.6)  # half a metre is less than the grain


def test_vertices_with_a_weight_move_up_in_order() -> None:
    rows, weights = vertices(np.arange(12.0).reshape(4, 3)), np.array([0.0, 0.3, 0.0, 0.7])
    assert drop(records(rows), 4, weights) == 2
    assert rows["ax"][:2].tolist() == [1.0, 3.0]
    assert rows["z"][:2].tolist() == [5.0, 11.0]
    assert weights[:2].tolist() == [0.3, 0.7]
