"""A normal that is a little askew between a round side and a line becomes exact, and no other."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from single_bodies import body, row, scratch_of, solid, spec_of, vector

from lavendersim.engine.collide.convex.separation import FACE_SHARE
from lavendersim.engine.collide.manifold import line_normal
from lavendersim.engine.vectors import Vec3

ASKEW = 1e-6


def better(pair: str, a, b, lines, n, more=0.0):
    """Return (normal, distance) after the kernel.

    It is given n and the separation along it, and so much `more`.
    """
    scratch = scratch_of([])
    for outline, ends in zip((scratch.outline_a, scratch.outline_b), lines, strict=True):
        for k, end in enumerate(ends):
            outline.corners[k].x, outline.corners[k].y, outline.corners[k].z = end - vector(a[0])
    found = scratch.separation[0]
    found.nx, found.ny, found.nz = n
    found.distance = solids.separation_along(solid(a), solid(b), n) + more
    offset = Vec3(*(vector(b[0]) - vector(a[0])))
    interpreted(line_normal.make_line_normal(spec_of(pair)))(row(a), row(b), offset, scratch)
    return vector(found, "n"), found.distance


def askew(n, rng):
    """Return a unit vector at ASKEW [rad] from n."""
    turned = n + ASKEW * np.cross(n, rng.normal(size=3))
    return turned / np.linalg.norm(turned)


def axis_ends(bodies) -> np.ndarray:
    shape = solid(bodies)
    return shape.centre + np.array([-1, 1])[:, None] * shape.half[2] * shape.matrix[:, 2]


@pytest.mark.parametrize("apart", [-1e-3, 1e-3])
@pytest.mark.parametrize("yaw", [0.3, np.pi / 2, 2.0])
def test_crossing_cylinders_part_across_both_axes(apart: float, yaw: float, rng) -> None:
    """n = u x w, though the centres are beside it; the gap is that of the axes less the radii."""
    for _ in range(6):
        world = convex.random_rotation(rng)
        u, w, n = world @ [1, 0, 0], world @ [np.cos(yaw), np.sin(yaw), 0], world[:, 2]
        a = body(
            "cylinder", (0.2, 0, 1.0), rng.normal(size=3), np.column_stack([n, np.cross(u, n), u])
        )
        middle = vector(a[0]) + (0.5 + apart) * n + 0.1 * u - 0.2 * w
        b = body("cylinder", (0.3, 0, 1.0), middle, np.column_stack([n, np.cross(w, n), w]))
        sides = axis_ends(a) + 0.2 * n, axis_ends(b) - 0.3 * n
        found, distance = better("cylinder_cylinder", a, b, sides, askew(n, rng))
        np.testing.assert_allclose(found, n, atol=1e-14)
        assert distance == pytest.approx(apart, abs=1e-14)


@pytest.mark.parametrize("tilt", [0.0, 0.4, -0.5])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_cylinder_along_an_edge_parts_across_from_the_edge(
    tilt: float, swapped: bool, rng
) -> None:
    """Lines are parallel: n leads from the edge to the axis, an edge being its own axis."""
    edge = np.array([0.0, 0.5, 0.3])
    n = np.array([0.0, np.sin(np.pi / 4 + tilt), np.cos(np.pi / 4 + tilt)])
    box = body("box", (0.5, 0.5, 0.3))
    along = np.column_stack([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    cylinder = body("cylinder", (0.2, 0, 0.4), edge + 0.201 * n, along)
    edges = edge + np.array([[-0.5, 0, 0], [0.5, 0, 0]])
    side = axis_ends(cylinder) - 0.2 * n
    if swapped:
        found, distance = better("cylinder_box", cylinder, box, (side, edges), askew(-n, rng))
        n = -n
    else:
        found, distance = better("cylinder_box", box, cylinder, (edges, side), askew(n, rng))
    np.testing.assert_allclose(found, n, atol=1e-14)
    assert distance == pytest.approx(1e-3, abs=1e-14)


def test_a_direction_that_parts_less_and_polyhedra_leave_the_normal(rng) -> None:
    a, b = body("cylinder", (0.2, 0, 1.0)), body("cylinder", (0.3, 0, 1.0), (0.6, 0.0, 0.1))
    n = askew(np.array([1.0, 0.0, 0.0]), rng)
    wrong = np.array([[0, 0, 0], [1, 1, 0.0]]), np.array([[0, 0, 0], [1.0, -1, 0]])
    ends = tuple(line + vector(a[0]) for line in wrong)
    _, distance = better("cylinder_cylinder", a, b, ends, n)
    assert distance >= solids.separation_along(solid(a), solid(b), n)
    boxes = body("box", (0.5, 0.5, 0.5)), body("box", (0.5, 0.5, 0.5), (1.1, 0.0, 0.0))
    kept, _ = better("cylinder_box", *boxes, wrong, n)
    np.testing.assert_array_equal(kept, n)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(("share", "exact"), [(0.9, True), (1.1, False)])
def test_what_separates_more_by_the_round_off_of_its_size_is_no_better(size, share, exact) -> None:
    """Two cylinders that cross; 1e-16 of their size is far below that share of it."""
    radii, n = np.array([0.2, 0.3]) * size, np.array([0.0, 0.0, 1.0])
    u, w = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    a = body("cylinder", (radii[0], 0, size), (0, 0, 0), np.column_stack([n, np.cross(u, n), u]))
    middle = 0.6 * size * n + 0.1 * size * (u - w)
    b = body("cylinder", (radii[1], 0, size), middle, np.column_stack([n, np.cross(w, n), w]))
    sides = axis_ends(a) + radii[0] * n, axis_ends(b) - radii[1] * n
    more = share * FACE_SHARE * (a["bound"][0] + b["bound"][0])
    _, distance = better("cylinder_cylinder", a, b, sides, n, more)
    expected = 0.1 * size + (0.0 if exact else more)
    assert distance == pytest.approx(expected, abs=0.05 * FACE_SHARE * size)
