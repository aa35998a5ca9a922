"""Faces and edges of a hull along n, against every face and every edge looked at in numpy."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from shape_laws import Seen, unit
from single_bodies import body, hull, row, scratch_of, solid

from lavendersim.engine.collide.records import FACE_LOOP, LINE, POINT
from lavendersim.engine.collide.shapes import polyhedron
from lavendersim.engine.collide.shapes.hull import make_edge, make_feature
from lavendersim.engine.collide.shapes.polyhedron import EDGES
from lavendersim.engine.vectors import Vec3


def faces_of(bodies, hulls):
    """Return (normal, corners) of every triangle in the world, from its loop."""
    corners, loops = hulls[0]
    matrix = solid(bodies, hulls).matrix
    found = []
    for loop in loops:
        p = corners[loop] @ matrix.T
        n = np.cross(p[1] - p[0], p[2] - p[0])
        found.append((n / np.linalg.norm(n), p))
    return found


def test_features_are_those_of_the_face_nearest_to_n(rng) -> None:
    kinds = set()
    for _ in range(60):
        a, hulls = hull(0.5 * rng.normal(size=(8, 3)), matrix=convex.random_rotation(rng))
        n = unit(rng)
        every = faces_of(a, hulls)
        normal, corners = max(every, key=lambda face: face[0] @ n)
        chosen = interpreted(polyhedron.facet_along)(row(a), 0, Vec3(*n), scratch_of(hulls).hulls)
        np.testing.assert_allclose(chosen.normal, normal, atol=1e-12)
        seen = Seen(make_feature, a, n, hulls)
        kinds.add(seen.feature.kind)
        if normal @ n >= 0.95:
            assert (seen.feature.kind, seen.feature.corners) == (FACE_LOOP, 3)
            np.testing.assert_allclose(
                np.sort(seen.world, axis=0), np.sort(corners, axis=0), atol=1e-14
            )
            np.testing.assert_allclose(seen.normal, normal, atol=1e-12)
            loop = hulls[0][1][seen.feature.name]
            np.testing.assert_allclose(hulls[0][0][loop] @ solid(a, hulls).matrix.T, corners)
        ends = [(corners[k], corners[(k + 1) % 3]) for k in range(3)]
        p, q = max(ends, key=lambda e: min(e[0] @ n, e[1] @ n))
        slope = abs((q - p) @ n) / np.linalg.norm(q - p)
        edge = Seen(make_edge, a, n, hulls)
        assert edge.feature.kind == (LINE if slope <= 0.3 else POINT)
        if edge.feature.kind == LINE:
            assert edge.feature.name >= EDGES
            found = {tuple(np.round(x, 12)) for x in edge.world}
            assert found == {tuple(np.round(x, 12)) for x in (p, q)}
        if normal @ n < 0.95:
            assert seen.feature.kind == edge.feature.kind
    assert kinds == {FACE_LOOP, LINE, POINT}


def test_an_edge_has_one_name_and_direction_from_either_of_its_faces() -> None:
    """A roof's ridge along x, 45 degrees to either side."""
    points = np.array([[x, y, z] for x in (-1, 1) for y, z in ((0, 1), (-1, 0), (1, 0))], float)
    hulls = [(points, [[0, 1, 4, 3], [3, 5, 2, 0], [1, 2, 5, 4], [0, 2, 1], [3, 4, 5]])]
    a = body("hull", (1, 1, 1), corners=points)
    names = set()
    ways = set()
    for side in (-0.1, 0.1):
        n = np.array([0.0, np.sin(side), np.cos(side)])
        seen = Seen(make_edge, a, n, hulls)
        assert seen.feature.kind == LINE
        np.testing.assert_allclose(seen.world[:, 1:], [[0.0, 1.0]] * 2, atol=1e-12)
        names.add(seen.feature.name)
        ways.add(float(np.sign(seen.world[1, 0] - seen.world[0, 0])))
    assert len(names) == len(ways) == 1


def test_the_box_is_the_last_row_and_equal_faces_keep_the_first(rng) -> None:
    _, hulls = hull(rng.normal(size=(8, 3)))
    tables = scratch_of(hulls).hulls
    last = interpreted(polyhedron.box_row)(tables)
    assert tables.vertex_start[last + 1] - tables.vertex_start[last] == 8
    a, _ = hull(rng.normal(size=(8, 3)))
    along = interpreted(polyhedron.facet_along)
    faces = {
        along(row(a), last, Vec3(1.0, 1.0 + noise, 0.0), tables).face
        for noise in (-1e-12, 0, 1e-12)
    }
    assert faces == {int(tables.face_start[last]) + 1}  # +x comes before +y


def test_the_flattest_edge_is_the_one_whose_lower_end_is_highest() -> None:
    outline = scratch_of([]).outline_a
    for k, place in enumerate([(0, 0, 0.0), (1, 0, 0.1), (1, 1, 0.3), (0, 1, 0.2)]):
        outline.corners[k].x, outline.corners[k].y, outline.corners[k].z = place
    edge, slope = interpreted(polyhedron.flattest_edge)(outline.corners, 4, Vec3(0.0, 0.0, 1.0))
    assert edge == 2
    assert slope == pytest.approx(0.1 / np.sqrt(1.01), abs=1e-15)
