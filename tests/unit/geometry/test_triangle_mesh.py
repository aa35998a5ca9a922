"""Triangles are a surface where they have area and meet in pairs that turn alike."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.geometry.triangle_mesh import MeshError, depth_behind, merged, surface_of

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)]


def test_normals_and_what_lies_beyond_each_side() -> None:
    surface = surface_of(np.array(SQUARE, float), np.array([(0, 1, 2), (0, 2, 3)]))
    np.testing.assert_array_equal(surface.normals, [(0, 0, 1), (0, 0, 1)])
    np.testing.assert_array_equal(surface.beyond, [(-1, -1, 1), (0, -1, -1)])


def test_vertices_at_one_place_are_one() -> None:
    places, triangles = merged(np.array([(0, 0, 0), (1, 0, 0), (0, 0, 0)], float), np.array([0, 2]))
    assert len(places) == 2
    assert triangles[0] == triangles[1]


def test_a_vertex_on_a_side_is_refused() -> None:
    """Two triangles share but half of a third one's side; one that is near its end is no twin."""
    places = np.array([(0, 0, 0), (2, 0, 0), (1, 0, 0), (1, -1, 0), (1, 1, 0)], float)
    with pytest.raises(MeshError, match=r"vertex at \(1, 0, 0\) lies on") as caught:
        surface_of(places, np.array([(0, 3, 1), (0, 2, 4), (2, 1, 4)]))
    assert caught.value.triangle == 0
    places[2] = (1e-10, 0, 0)
    with pytest.raises(MeshError, match="share whole sides"):
        surface_of(places, np.array([(0, 3, 1), (2, 1, 4)]))


def test_inside_of_a_notched_block_a_point_is_behind_by_its_distance() -> None:
    """A prism over an L of unit squares: its notch ends in a concave edge at (1, 1)."""
    loop = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    places = np.array([(x, y, z) for z in (0, 2) for x, y in loop], float)
    fan = [(3, k, (k + 1) % 6) for k in range(6) if k != 3 and (k + 1) % 6 != 3]
    walls = [t for k in range(6) for j in [(k + 1) % 6] for t in ((k, j, j + 6), (k, j + 6, k + 6))]
    triangles = [(a, c, b) for a, b, c in fan] + [(a + 6, b + 6, c + 6) for a, b, c in fan] + walls
    surface = surface_of(places, np.array(triangles))
    assert (surface.beyond >= 0).all()
    inside = {
        (0.9, 0.9): 0.1 * np.sqrt(2.0),
        (0.5, 1.7): 0.3,
        (1.5, 0.2): 0.2,
        (0.9, 0.8): 0.05**0.5,
    }
    for (x, y), depth in inside.items():
        assert depth_behind(surface, np.array((x, y, 1.0))) == pytest.approx(depth, abs=1e-14)
    for x, y in ((1.1, 1.1), (2.1, -0.1), (2.3, 0.9), (1.5, 1.4), (-3.0, 0.5)):
        assert depth_behind(surface, np.array((x, y, 1.0))) == 0.0
    assert depth_behind(surface, np.array((2.1, -0.2, 2.3))) == 0.0


@pytest.mark.parametrize(
    ("triangles", "row", "sentence"),
    [
        ([(0, 1, 2), (0, 1, 1)], 1, "on a line"),
        ([(0, 1, 2), (1, 0, 3), (0, 1, 4)], 2, "the third triangle"),
        ([(0, 1, 2), (0, 3, 2), (3, 2, 0)], 2, "it is triangle 1 again"),
        ([(0, 1, 2), (0, 3, 2)], 1, "other way round than those of triangle 0"),
    ],
)
def test_what_is_no_surface_is_named_by_its_triangle(triangles, row: int, sentence: str) -> None:
    with pytest.raises(MeshError, match=sentence) as caught:
        surface_of(np.array(SQUARE, float), np.array(triangles))
    assert caught.value.triangle == row
