"""Hulls: which points are corners, which triangles are one face, and which points have no hull."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from lavendersim.geometry.convex_hull import FlatError, Polyhedron, convex_hull

CUBE = [(float(x), float(y), float(z)) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def edges(hull: Polyhedron) -> list[tuple[int, int]]:
    """Every edge as each of its faces walks it."""
    loops = ([*face, face[0]] for face in hull.faces)
    return [pair for loop in loops for pair in itertools.pairwise(loop)]


def assert_closed(hull: Polyhedron) -> None:
    """Two faces share each edge and walk it in opposite directions; Euler's V - E + F = 2."""
    walked = edges(hull)
    assert len(set(walked)) == len(walked)
    assert {(b, a) for a, b in walked} == set(walked)
    assert len(hull.points) - len(walked) // 2 + len(hull.faces) == 2


def heights(hull: Polyhedron, points) -> np.ndarray:
    """How far each point lies outside of each face [m], by Newell's normal of the loop."""
    corners = np.array(hull.points)
    found = []
    for face in hull.faces:
        loop = corners[list(face)]
        normal = np.cross(loop - loop[0], np.roll(loop, -1, axis=0) - loop[0]).sum(axis=0)
        normal /= np.linalg.norm(normal)
        found.append((np.array(points) - loop[0]) @ normal)
    return np.array(found)


def test_points_inside_on_faces_and_on_edges_are_no_corners() -> None:
    more = [(0.5, 0.5, 0.5), (0.5, 0.5, 1.0), (0.5, 1.0, 1.0), (0.25, 0.0, 0.75), *CUBE[:3]]
    hull = convex_hull([*CUBE, *more])
    assert set(hull.points) == set(CUBE)
    assert sorted(len(face) for face in hull.faces) == [4] * 6
    assert_closed(hull)
    assert heights(hull, [(0.5, 0.5, 0.5)]).max() == pytest.approx(-0.5, abs=1e-15)


def hull_of(points: np.ndarray) -> Polyhedron:
    return convex_hull([tuple(point) for point in points.tolist()])


# Coordinates are off by so much, as those that a program has turned or written as text are.
NOISE = 1e-12
SLACK = 3 * NOISE  # of a point and of the corners of a face, that lean it


@pytest.mark.parametrize("seed", range(40))
def test_what_prolongs_an_edge_is_a_corner_however_it_is_rounded(seed: int) -> None:
    """A house: a cube, one edge or two prolonged, whose old ends are then within an edge."""
    rng = np.random.default_rng(seed)
    tips = [(0.0, 0.0, 2.0), (0.0, 1.0, 2.0)][: 1 + seed % 2]
    # With both tips (0, 0, 1) and (0, 1, 1) are on edges; with one, (0, 1, 1) is a corner.
    corners = {*CUBE, *tips} - {(x, y, 1.0) for x, y, _ in tips}
    everything = np.array([*CUBE, *tips, (0.0, 0.0, 1.5), (0.0, 0.0, 0.25), (0.5, 0.0, 0.0)])
    points = everything + rng.uniform(-NOISE, NOISE, everything.shape)
    hull = hull_of(points[rng.permutation(len(points))])
    assert heights(hull, points).max() < SLACK
    assert {tuple(abs(round(x, 9)) for x in corner) for corner in hull.points} == corners
    assert_closed(hull)


@pytest.mark.parametrize("seed", range(60))
def test_every_point_is_inside_the_hull(seed: int) -> None:
    """Points of a lattice, most of them on lines and planes of others, turned or not, rounded."""
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(-2, 3, size=(40, 3)), axis=0).astype(float)
    if seed % 2:
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        points = points @ turn.T
    points += rng.uniform(-NOISE, NOISE, points.shape)
    hull = hull_of(points)
    assert heights(hull, points).max() < 10 * SLACK  # edges of 4 lean narrower faces
    assert_closed(hull)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_hull_of_random_points_holds_them_all(scale: float) -> None:
    points = (np.random.default_rng(7).normal(size=(60, 3)) * scale).tolist()
    hull = convex_hull([tuple(point) for point in points])
    assert_closed(hull)
    assert {len(face) for face in hull.faces} == {3}
    # Qhull's own facets may miss a point by some roundings of its coordinates
    assert heights(hull, points).max() < 1e-14 * scale * 10


def test_faces_of_a_turned_cylinder_stay_whole() -> None:
    """A prism of 12 sides turned anyhow: 12 sides and 2 caps, although its points are rounded."""
    around = np.arange(12) * np.pi / 6
    ring = np.column_stack([np.cos(around), np.sin(around)])
    prism = np.array([(x, y, z) for x, y in ring for z in (-0.3, 0.3)])
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    hull = convex_hull([tuple(point) for point in (prism @ turn.T + 10.0).tolist()])
    assert sorted(len(face) for face in hull.faces) == [4] * 12 + [12] * 2
    assert_closed(hull)


@pytest.mark.parametrize(
    "points",
    [
        [(0.0, 0.0, 0.0)] * 4,
        [(float(k), 0.0, 0.0) for k in range(4)],
        [(float(x), float(y), 0.0) for x in (0, 1) for y in (0, 1)],
        [(float(x), float(y), 1e-7 * x * y) for x in (0, 1) for y in (0, 1)],
        [(x, y, 0.5 * x + 0.3 * y) for x in (0.0, 1.0) for y in (0.0, 1.0, 2.0)],
        # A needle of 6e12 m, 1 m thick: every face is a line, to a rounding.
        [(0.0, 5.99e12, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.1, 0.1, 0.1)],
    ],
)
def test_points_without_volume_are_refused(points) -> None:
    with pytest.raises(FlatError):
        convex_hull(points)


def test_thin_plate_is_a_hull() -> None:
    plate = [(x, y, 1e-4 * z) for x, y, z in CUBE]
    assert len(convex_hull(plate).faces) == 6
