"""Four points of many: the deepest stays, and the area spanned is near that of the best choice.

With p the deepest, q the farthest from it and r at the height h over p q that makes the largest
triangle, every point lies within h of the line p q and within |p q| of p: no quadrilateral has more
than 4 |p q| h. Ours has at least the triangle's |p q| h / 2, an eighth. Polygons that clipping
makes do better: of the best quadrilateral with the deepest point the worst of 4000 kept 0.74.
"""

from __future__ import annotations

from itertools import combinations, permutations

import numpy as np
import pytest

from lavendersim.engine.collide.manifold.point import keep_four
from lavendersim.engine.records import POINT, dtype
from lavendersim.engine.vectors import Vec3


def area(points):
    """Largest shoelace area over the orders of up to four points in the plane."""
    best = 0.0
    for order in permutations(points[1:]):
        loop = np.array([points[0], *order])
        following = np.roll(loop, -1, axis=0)
        twice = np.sum(loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0])
        best = max(best, 0.5 * abs(float(twice)))
    return best


def polygons(rng, count):
    for _ in range(count):
        corners = rng.integers(5, 9)
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, corners))
        stretch = 10.0 ** rng.uniform(-2.0, 0.0)
        yield np.column_stack([np.cos(angle), stretch * np.sin(angle)]), rng.uniform(-1, 0, corners)


def reduce_to_four(plane_points, phi):
    points = np.zeros(16, dtype(POINT))
    points["x"][: len(phi)], points["y"][: len(phi)] = plane_points.T
    points["phi"][: len(phi)] = phi
    points["feature"][: len(phi)] = np.arange(len(phi))
    count = keep_four(points, len(phi), Vec3(0.0, 0.0, 1.0))
    return points[:count]


def test_the_deepest_point_stays_and_no_point_is_moved_or_doubled(rng):
    for plane_points, phi in polygons(rng, 500):
        kept = reduce_to_four(plane_points, phi)
        assert kept["phi"].min() == phi.min()
        assert len(set(kept["feature"])) == len(kept) <= 4
        for point in kept:
            np.testing.assert_array_equal([point["x"], point["y"]], plane_points[point["feature"]])
            assert point["phi"] == phi[point["feature"]]


def test_the_area_is_near_the_best_with_the_deepest_point(rng):
    for plane_points, phi in polygons(rng, 300):
        kept = reduce_to_four(plane_points, phi)
        deepest = int(np.argmin(phi))
        others = [i for i in range(len(phi)) if i != deepest]
        best = max(
            area(plane_points[[deepest, *three]]) for three in map(list, combinations(others, 3))
        )
        ours = area(np.column_stack([kept["x"], kept["y"]]))
        assert ours >= 0.7 * best
        anything = max(area(plane_points[list(four)]) for four in combinations(range(len(phi)), 4))
        assert ours >= anything / 8.0


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_few_points_stay_as_they_are(count, rng):
    phi = rng.uniform(-1.0, 0.0, count)
    kept = reduce_to_four(rng.normal(size=(count, 2)), phi)
    np.testing.assert_array_equal(kept["phi"], phi)


def test_points_on_one_line_keep_both_ends():
    line = np.column_stack([np.linspace(-1.0, 1.0, 6), np.zeros(6)])
    kept = reduce_to_four(line, np.linspace(0.0, -1.0, 6))
    assert {-1.0, 1.0} <= set(kept["x"])
