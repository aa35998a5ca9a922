"""A capsule along an edge touches the edge; on a face, or across the edge, the face itself."""

from __future__ import annotations

import convex
import numpy as np
import pytest
from interpreted import interpreted
from single_bodies import body, row, scratch_of, spec_of, vector

from lavendersim.engine.collide.manifold import edge_line
from lavendersim.engine.collide.records import FACE_LOOP, LINE
from lavendersim.engine.collide.shape_kernels import make_feature
from lavendersim.engine.vectors import Vec3

HALF, HEIGHT = 0.5, 0.3  # of the box: its edge leads along x at y = HALF, z = HEIGHT
LENGTH = 0.2


def features(degrees: float, yaw: float = 0.0, swapped: bool = False):
    """Return (line of the capsule, feature of the box, its outline): n is so far from z about x.

    swapped: the capsule is body A.
    """
    angle = np.radians(degrees)
    n = np.array([0.0, np.sin(angle), np.cos(angle)])
    box = body("box", (HALF, HALF, HEIGHT))
    centre = np.array([0.0, HALF, HEIGHT]) + 0.1 * n
    along = convex.matrix_of([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])  # z along x
    turn = convex.matrix_of([np.cos(yaw / 2), *(np.sin(yaw / 2) * n)])
    capsule = body("capsule", (0.1, 0.0, LENGTH), centre, turn @ along)
    a, b = (capsule, box) if swapped else (box, capsule)
    scratch = scratch_of([])
    spec = spec_of("capsule_box")
    normal = -n if swapped else n
    found = scratch.separation[0]
    found.nx, found.ny, found.nz = normal
    offset = Vec3(*(vector(b[0]) - vector(a[0])))
    feature = interpreted(make_feature(spec))
    of_a = feature(row(a), Vec3(0, 0, 0), Vec3(*normal), scratch.hulls, scratch.outline_a)
    of_b = feature(row(b), offset, Vec3(*-normal), scratch.hulls, scratch.outline_b)
    kernel = interpreted(edge_line.make_edge_along(spec))
    of_a, of_b = kernel(row(a), row(b), offset, of_a, of_b, scratch)
    if swapped:
        return of_a, of_b, scratch.outline_b, vector(capsule[0])
    return of_b, of_a, scratch.outline_a, np.zeros(3)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("degrees", [0.1, 10.0, 17.0])
def test_beside_the_face_normal_the_edge_is_taken(degrees: float, swapped: bool) -> None:
    line, edge, outline, origin = features(degrees, swapped=swapped)
    assert (line.kind, line.corners) == (LINE, 2)
    assert (edge.kind, edge.corners) == (LINE, 2)
    ends = np.array([vector(outline.corners[k]) for k in range(2)]) + origin
    ends = ends[np.argsort(ends[:, 0])]
    np.testing.assert_allclose(ends, [[-HALF, HALF, HEIGHT], [HALF, HALF, HEIGHT]], atol=1e-15)


@pytest.mark.parametrize("swapped", [False, True])
def test_on_the_face_and_across_the_edge_the_face_stays(swapped: bool) -> None:
    """Along its own normal, and turned so far that lines cross: its loop is in the outline."""
    for degrees, yaw in ((0.0, 0.0), (10.0, 0.1)):
        line, face, outline, origin = features(degrees, yaw, swapped)
        assert line.kind == LINE
        assert (face.kind, face.corners) == (FACE_LOOP, 4)
        corners = np.array([vector(outline.corners[k]) for k in range(4)]) + origin
        np.testing.assert_allclose(corners[:, 2], HEIGHT, atol=1e-15)
        np.testing.assert_allclose(np.abs(corners[:, :2]), HALF, atol=1e-15)


def test_lines_are_parallel_below_the_angle_at_which_they_cross() -> None:
    scratch = scratch_of([])
    parallel = interpreted(edge_line.parallel)
    for sine, expected in ((0.0, True), (0.0019, True), (0.0021, False), (1.0, False)):
        for outline, end in (
            (scratch.outline_a, (2.0, 0.0)),
            (scratch.outline_b, (3.0, 3.0 * sine)),
        ):
            outline.corners[0].x, outline.corners[0].y = 0.5, 0.5
            outline.corners[1].x, outline.corners[1].y = 0.5 + end[0], 0.5 + end[1]
        assert parallel(scratch.outline_a, scratch.outline_b) is expected


def test_only_pairs_of_a_line_and_an_edge_have_the_kernel() -> None:
    for pair, has in (
        ("capsule_box", True), ("cylinder_hull", True), ("box_box", False), ("hull_hull", False),
        ("capsule_cylinder", False), ("sphere_box", False),
    ):  # fmt: skip
        assert (edge_line.make_edge_along(spec_of(pair)) is not None) is has
