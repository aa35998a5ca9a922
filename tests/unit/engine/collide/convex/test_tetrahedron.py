"""Whatever GJK ends with becomes four vertices of the difference that span a volume."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from single_bodies import body, row, scratch_of, solid, spec_of, vector, vertices_of

from lavendersim.engine.collide.convex import tetrahedron
from lavendersim.engine.collide.scratch import NEW_VERTEX
from lavendersim.engine.vectors import Vec3

FIELDS = ("x", "y", "z", "ax", "ay", "az", "bx", "by", "bz")


def vertices(points):
    rows = scratch_of([]).polytope.vertices
    for k, place in enumerate(points):
        for name, value in zip(FIELDS, (*place, *(10.0 + k + np.arange(6))), strict=True):
            rows[k][name] = value
    return rows


def test_distances_from_point_line_and_plane(rng) -> None:
    for _ in range(20):
        p = rng.normal(size=(4, 3))
        rows, u = vertices(p), p[1] - p[0]
        assert interpreted(tetrahedron.off_point)(rows, 1, 3) == pytest.approx(
            np.sum((p[3] - p[1]) ** 2), rel=1e-14
        )
        foot = p[0] + u * (u @ (p[2] - p[0])) / (u @ u)
        assert interpreted(tetrahedron.off_line)(rows, 0, 1, 2) == pytest.approx(
            np.sum((p[2] - foot) ** 2), rel=1e-12
        )
        height, n = interpreted(tetrahedron.above_plane)(rows, 3)
        volume = np.linalg.det([u, p[2] - p[0], p[3] - p[0]]) / 6.0
        area = 0.5 * np.linalg.norm(np.cross(u, p[2] - p[0]))
        assert height == pytest.approx(3.0 * volume / area, rel=1e-12)
        np.testing.assert_allclose(n, np.cross(u, p[2] - p[0]), rtol=1e-13)


def test_vertices_are_exchanged_whole(rng) -> None:
    rows = vertices(rng.normal(size=(3, 3)))
    one, other = ([rows[k][name] for name in FIELDS] for k in (0, 2))
    interpreted(tetrahedron.swap_vertices)(rows, 0, 2)
    assert [rows[2][name] for name in FIELDS] == one
    assert [rows[0][name] for name in FIELDS] == other


def test_directions_are_the_six_along_axes_and_two_across_a_line(rng) -> None:
    six = {tuple(interpreted(tetrahedron.along_an_axis)(side)) for side in range(6)}
    assert six == {tuple(s * e) for s in (1.0, -1.0) for e in np.eye(3)}
    for u in (*np.eye(3), *rng.normal(size=(20, 3))):
        p, q = map(np.array, interpreted(tetrahedron.across_line)(Vec3(*u)))
        assert abs(p @ u) + abs(q @ u) + abs(p @ q) < 1e-14 * (u @ u)
        assert np.linalg.norm(p) == pytest.approx(np.linalg.norm(q), rel=1e-14)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize("alike", [False, True])
def test_four_vertices_of_the_difference_span_a_volume(count: int, alike: bool, rng) -> None:
    """What GJK found is kept, unless it is all in one place: then only the first."""
    make = interpreted(tetrahedron.make_tetrahedron(spec_of("box_box")))
    for _ in range(15):
        a = body("box", rng.uniform(0.2, 0.6, 3), matrix=convex.random_rotation(rng))
        centre = 0.3 * rng.normal(size=3)
        b = body("box", rng.uniform(0.2, 0.6, 3), centre, convex.random_rotation(rng))
        p, q = vertices_of(solid(a)), vertices_of(solid(b))
        every = np.array([(*(x - y), *x, *y) for x in p for y in q])
        chosen = every[rng.integers(len(every), size=1 if alike else count)]
        first = np.repeat(chosen, count, axis=0) if alike else chosen
        scratch = scratch_of([])
        rows = scratch.polytope.vertices
        for k, values in enumerate(first):
            for name, value in zip(FIELDS, values, strict=True):
                rows[k][name] = value
        make(row(a), row(b), Vec3(*centre), count, rows, scratch.hulls)
        corners = np.array([vector(rows[k]) for k in range(4)])
        volume = abs(np.linalg.det(corners[1:] - corners[0])) / 6.0
        assert volume > 1e-12  # a simplex of the difference thinner than this is built anew
        for k in range(4):
            whole = np.array([rows[k][name] for name in FIELDS])
            assert np.abs(every - whole).max(axis=1).min() < 1e-13
        np.testing.assert_array_equal(corners[0], first[0][:3])


def test_a_simplex_with_a_volume_stays_as_it_is(rng) -> None:
    make = interpreted(tetrahedron.make_tetrahedron(spec_of("box_box")))
    a, b = body("box", (0.5, 0.4, 0.3)), body("box", (0.2, 0.2, 0.2))
    points = np.array([[0.7, 0.6, 0.5], [-0.7, -0.6, 0.5], [0.7, -0.6, -0.5], [-0.7, 0.6, -0.5]])
    rows = vertices(points)
    make(row(a), row(b), Vec3(0.0, 0.0, 0.0), 4, rows, scratch_of([]).hulls)
    kept = np.array([vector(rows[k]) for k in range(4)])
    assert {tuple(p) for p in kept} == {tuple(p) for p in points}
    assert not rows.array["x"][NEW_VERTEX:].any()  # no support was asked for
