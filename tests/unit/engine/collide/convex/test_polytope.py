"""A polytope that grows point by point is the convex hull of its points, closed and outward."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted
from scipy.spatial import ConvexHull
from single_bodies import scratch_of, vector

from lavendersim.engine.collide.convex import epa, polytope
from lavendersim.engine.collide.records import UNBOUNDED

put_face, join, nearest_face, flood, grow, put_tetrahedron = (
    interpreted(one)
    for one in (
        polytope.put_face,
        polytope.join,
        polytope.nearest_face,
        polytope.flood,
        polytope.grow,
        epa.put_tetrahedron,
    )
)


def put(rows, k: int, place) -> None:
    rows[k].x, rows[k].y, rows[k].z = place


class Mesh:
    """The polytope of a list of points, each of which lies outside of those before it."""

    def __init__(self, points: np.ndarray) -> None:
        self.mesh = scratch_of([]).polytope
        for k in range(4):
            put(self.mesh.vertices, k, points[k])
        self.count = put_tetrahedron(self.mesh)
        for k in range(4, len(points)):
            self.add(k, points[k])

    def add(self, k: int, place) -> None:
        put(self.mesh.vertices, k, place)
        heights = {t: vector(f, "n") @ place - f.offset for t, f in self.faces()}
        start = max(heights, key=heights.get)
        assert heights[start] > 0.0
        seen = flood(self.mesh, k, start, 0.0)
        assert sorted(self.mesh.queue[:seen]) == sorted(t for t, h in heights.items() if h > 0.0)
        self.count = grow(self.mesh, k, self.count, seen)
        assert self.count > 0

    def faces(self):
        return [(t, f) for t in range(self.count) if (f := self.mesh.faces[t]).alive]

    def place(self, k: int) -> np.ndarray:
        return vector(self.mesh.vertices[k])


def outward(rng, count: int) -> np.ndarray:
    """Return points on growing spheres about the origin: each outside of the hull of the others."""
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    points[:4] = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    return points * (2.0 + 0.5 * np.arange(count)[:, None])


@pytest.mark.parametrize("count", [4, 5, 12, 40])
def test_it_is_the_convex_hull(count: int, rng) -> None:
    points = outward(rng, count)
    mesh, hull = Mesh(points), ConvexHull(points)
    planes = sorted((*np.round(vector(f, "n"), 9), round(f.offset, 9)) for _, f in mesh.faces())
    expected = sorted((*np.round(e[:3], 9), round(-e[3], 9)) for e in hull.equations)
    np.testing.assert_allclose(planes, expected, atol=2e-9)
    volume = 0.0
    for t, _ in mesh.faces():
        p, q, r = (mesh.place(k) for k in mesh.mesh.corners[t])
        volume += np.dot(p, np.cross(q, r)) / 6.0
    assert volume == pytest.approx(hull.volume, rel=1e-12)
    assert (
        nearest_face(mesh.mesh.faces, mesh.count) == min(mesh.faces(), key=lambda f: f[1].offset)[0]
    )


def test_the_mesh_is_closed_and_neighbours_share_their_edge(rng) -> None:
    mesh = Mesh(outward(rng, 30))
    alive = dict(mesh.faces())
    corners, neighbours = mesh.mesh.corners, mesh.mesh.neighbours
    for t in alive:
        for edge in range(3):
            i, j, f = corners[t, edge], corners[t, (edge + 1) % 3], neighbours[t, edge]
            assert f in alive
            back = [(corners[f, e], corners[f, (e + 1) % 3]) for e in range(3)].index((j, i))
            assert neighbours[f, back] == t
    vertices = {int(k) for t in alive for k in corners[t]}
    assert len(vertices) - 3 * len(alive) // 2 + len(alive) == 2  # Euler


def test_a_first_tetrahedron_of_either_hand_turns_outward(rng) -> None:
    points = outward(rng, 4)
    for order in ((0, 1, 2, 3), (1, 0, 2, 3)):
        mesh = Mesh(points[list(order)])
        for _, face in mesh.faces():
            assert face.offset > 0.0  # the origin is inside
        mesh_points = {tuple(mesh.place(k)) for k in range(4)}
        assert mesh_points == {tuple(p) for p in points}


def test_a_face_without_area_is_never_the_nearest() -> None:
    mesh = scratch_of([]).polytope
    for k, place in enumerate([(0, 0, 1), (1, 0, 1), (2, 0, 1), (0, 1, 1)]):
        put(mesh.vertices, k, place)
    put_face(mesh, 0, 0, 1, 2)
    put_face(mesh, 1, 0, 1, 3)
    assert mesh.faces[0].offset == UNBOUNDED
    np.testing.assert_array_equal(vector(mesh.faces[1], "n"), (0.0, 0.0, 1.0))
    assert mesh.faces[1].offset == 1.0
    assert nearest_face(mesh.faces, 2) == 1
    mesh.faces[1].alive = 0
    assert nearest_face(mesh.faces, 2) == 0


def test_what_lies_in_the_plane_of_a_face_by_the_slack_does_not_see_it(rng) -> None:
    mesh = Mesh(outward(rng, 4))
    t, face = mesh.faces()[0]
    n, centre = vector(face, "n"), np.mean([mesh.place(k) for k in mesh.mesh.corners[t]], axis=0)
    others = [k for k, _ in mesh.faces() if k != t]
    put(mesh.mesh.vertices, 4, centre + 1e-3 * n)
    assert flood(mesh.mesh, 4, others[0], 2e-3) == 1  # from another face: this one is not joined
    put(mesh.mesh.vertices, 5, centre + 1e-3 * n)
    assert flood(mesh.mesh, 5, others[0], 0.5e-3) == 2


def test_a_mesh_without_room_or_with_a_torn_rim_is_refused(rng) -> None:
    points = outward(rng, 5)
    mesh = Mesh(points[:4])
    put(mesh.mesh.vertices, 4, points[4])
    heights = [vector(f, "n") @ points[4] - f.offset for _, f in mesh.faces()]
    seen = flood(mesh.mesh, 4, int(np.argmax(heights)), 0.0)
    full = mesh.mesh._replace(faces=mesh.mesh.faces[:5])
    assert grow(full, 4, 4, seen) == -1
