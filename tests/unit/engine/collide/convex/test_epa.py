"""The depth is the least height of the Minkowski difference's faces, by scipy's convex hull."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from scipy.spatial import ConvexHull
from single_bodies import body, hull, row, scratch_of, solid, spec_of, vector, vertices_of

from lavendersim.engine.collide.convex import epa, gjk
from lavendersim.engine.vectors import Vec3


class Overlap:
    """Two bodies that overlap, and what EPA finds after GJK."""

    def __init__(self, pair: str, a, b, hulls=(), curved: bool = False) -> None:
        self.a, self.b, self.hulls = a, b, list(hulls)
        self.solids = solid(a, hulls), solid(b, hulls)
        self.centre = vector(a[0])
        offset = Vec3(*(vector(b[0]) - self.centre))
        self.scratch, spec = scratch_of(self.hulls), spec_of(pair)
        walk, expand = interpreted(gjk.make_gjk(spec)), interpreted(epa.make_epa(spec))
        status, count = walk(row(a), row(b), offset, 1e9, self.scratch)
        assert status == gjk.OVERLAPPING
        expand(row(a), row(b), offset, count, curved, self.scratch)
        found = self.scratch.separation[0]
        self.distance, self.normal = found.distance, vector(found, "n")
        self.of_a, self.of_b = vector(found, "a"), vector(found, "b")
        self.size = float(a["bound"][0] + b["bound"][0])

    def least_height(self) -> float:
        """Return the depth of two polyhedra: the least height of a face of A - B."""
        p, q = map(vertices_of, self.solids)
        return float(-ConvexHull((p[:, None] - q[None]).reshape(-1, 3)).equations[:, 3].max())

    def check(self, tolerance: float) -> None:
        """The points are A's and B's, and the way from one to the other is the depth along n."""
        assert np.linalg.norm(self.normal) == pytest.approx(1.0, abs=1e-12)
        way = self.of_b - self.of_a
        np.testing.assert_allclose(way, self.distance * self.normal, atol=tolerance)
        for shape, point in zip(self.solids, (self.of_a, self.of_b), strict=True):
            assert solids.off_surface(shape, self.centre + point) <= tolerance


@pytest.mark.parametrize("pair", ["box_box", "hull_box"])
def test_two_polyhedra_are_as_deep_as_their_difference_is_high(pair: str, rng) -> None:
    for _ in range(25):
        a = body("box", rng.uniform(0.2, 0.6, 3), rng.normal(size=3), convex.random_rotation(rng))
        centre = vector(a[0]) + 0.2 * rng.normal(size=3)
        turn = convex.random_rotation(rng)
        b, hulls = body("box", rng.uniform(0.2, 0.6, 3), centre, turn), []
        if pair == "hull_box":
            b, hulls = hull(rng.normal(size=(14, 3)) * 0.5, centre, turn)
        overlap = Overlap(pair, a, b, hulls)
        depth = overlap.least_height()
        assert overlap.distance == pytest.approx(-depth, abs=1e-12 * overlap.size)
        proved = solids.separation_along(*overlap.solids, overlap.normal)
        assert proved == pytest.approx(-depth, abs=1e-12 * overlap.size)
        overlap.check(1e-12 * overlap.size)


def test_touching_and_coincident_boxes_have_their_closed_forms() -> None:
    lower = body("box", (0.5, 0.4, 0.3))
    touching = Overlap("box_box", lower, body("box", (0.2, 0.2, 0.2), (0.1, 0.1, 0.5)))
    assert touching.distance == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(touching.normal, (0, 0, 1), atol=1e-12)
    inside = Overlap("box_box", lower, body("box", (0.2, 0.2, 0.2)))
    assert inside.distance == pytest.approx(-0.5, abs=1e-12)  # out along z: 0.3 + 0.2
    assert abs(inside.normal[2]) == pytest.approx(1.0, abs=1e-12)


def test_a_face_of_several_triangles_has_its_witness_where_the_ray_leaves_it() -> None:
    """Boxes face to face: the origin's ray leaves the difference in its own face, and the two
    points have the same x and y; both lie in the overlap of the faces."""
    for x, y in ((0.05, 0.1), (-0.2, 0.05), (0.15, -0.1)):
        found = Overlap(
            "box_box", body("box", (0.5, 0.4, 0.3)), body("box", (0.4, 0.3, 0.2), (x, y, 0.45))
        )
        assert found.distance == pytest.approx(-0.05, abs=1e-12)
        found.check(1e-12)
        assert found.of_a[2] == pytest.approx(0.3, abs=1e-12)
        assert found.of_b[2] == pytest.approx(0.25, abs=1e-12)


def test_round_cores_end_at_a_share_of_their_depth_and_sizes(rng) -> None:
    """Never less deep than the true depth, the least over directions; deeper by the shares."""
    directions = rng.normal(size=(3000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    for _ in range(6):
        a = body("cylinder", (0.4, 0.0, 0.3), matrix=convex.random_rotation(rng))
        b = body("box", (0.3, 0.2, 0.4), 0.2 * rng.normal(size=3), convex.random_rotation(rng))
        overlap = Overlap("cylinder_box", b, a, curved=True)
        best = max(solids.separation_along(*overlap.solids, n) for n in directions)
        slack = epa.ROUND_SIZE * overlap.size + epa.ROUND_SHARE * abs(overlap.distance)
        proved = solids.separation_along(*overlap.solids, overlap.normal)
        assert overlap.distance == pytest.approx(proved, abs=1e-12)
        assert overlap.distance >= best - slack
        overlap.check(0.1 * overlap.size)  # a chord's points are beside the ray


def test_vertices_that_run_out_are_counted_and_what_was_found_is_kept(rng, monkeypatch) -> None:
    a = body("cylinder", (0.4, 0.0, 0.3), matrix=convex.random_rotation(rng))
    b = body("cylinder", (0.3, 0.0, 0.3), (0.1, 0.1, 0.1), convex.random_rotation(rng))
    whole = Overlap("cylinder_cylinder", a, b, curved=True)
    assert whole.scratch.not_converged[0].epa == 0
    monkeypatch.setattr(epa, "EPA_VERTICES", 6)
    few = Overlap("cylinder_cylinder", a, b, curved=True)
    assert few.scratch.not_converged[0].epa == 1
    assert few.distance < whole.distance < 0.0
    assert few.distance == pytest.approx(
        solids.separation_along(*few.solids, few.normal), abs=1e-12
    )
