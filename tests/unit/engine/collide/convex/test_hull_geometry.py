"""An edge of a hull has one name and one direction, whichever of its two faces it is found from.

A box is the last row of the tables, stretched by its half edges.
"""

from __future__ import annotations

import numpy as np

from lavendersim.engine.collide.convex.hull_geometry import UNIT_BOX, hull_geometry
from lavendersim.engine.collide.scratch import allocate_scratch

TETRAHEDRON = (
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
)


def edge_ends(tables, k):
    """Rows of `vertices` that edge k leads from and to."""
    face = int((tables.loop_start <= k).sum()) - 1
    first, last = tables.loop_start[face : face + 2]
    return tables.loops[k], tables.loops[first + (k + 1 - first) % (last - first)]


def test_both_faces_of_an_edge_name_the_same_mention_of_it():
    tables = hull_geometry([TETRAHEDRON, UNIT_BOX])
    for k, named in enumerate(tables.edges):
        start, end = edge_ends(tables, k)
        assert edge_ends(tables, named) == ((start, end) if named == k else (end, start))
        assert named <= k


def test_a_solid_has_half_as_many_edges_as_corners_of_loops():
    """Euler: a tetrahedron has 6, a box 12; hulls never share one."""
    tables = hull_geometry([TETRAHEDRON, UNIT_BOX])
    assert len(set(tables.edges[:12].tolist())) == 6
    assert len(set(tables.edges[12:36].tolist())) == 12
    assert len(set(tables.edges[36:].tolist())) == 12


def test_the_scratch_without_hulls_holds_the_unit_box():
    hulls = allocate_scratch().hulls
    assert hulls.vertex_start.tolist() == [0, 8]
    np.testing.assert_allclose(np.abs(hulls.normals).sum(axis=0), [2.0, 2.0, 2.0])
    np.testing.assert_array_equal(hulls.offsets, np.ones(6))
