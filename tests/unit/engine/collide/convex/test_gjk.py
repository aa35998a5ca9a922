"""GJK's distance is proved by its own normal and witness points, and its overlap by its simplex."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from single_bodies import body, hull, row, scratch_of, solid, spec_of, vector, vertices_of

from lavendersim.engine.collide.convex import gjk
from lavendersim.engine.vectors import Vec3

PAIR = "hull_box"
SPEC = spec_of(PAIR)
ANYWHERE = 1e9


class Bodies:
    """A turned box and a turned hull of twelve points, at a distance of centres [m]."""

    def __init__(self, rng, apart: float) -> None:
        centre = rng.normal(size=3)
        way = rng.normal(size=3)
        way *= apart / np.linalg.norm(way)
        self.a = body("box", rng.uniform(0.2, 0.6, 3), centre, convex.random_rotation(rng))
        self.b, self.hulls = hull(
            0.5 * rng.normal(size=(12, 3)), centre + way, convex.random_rotation(rng)
        )
        self.scratch = scratch_of(self.hulls)
        self.offset = Vec3(*way)
        self.solids = solid(self.a), solid(self.b, self.hulls)
        self.size = float(self.a["bound"][0] + self.b["bound"][0])

    def walk(self, reach: float = ANYWHERE):
        kernel = interpreted(gjk.make_gjk(SPEC))
        return kernel(row(self.a), row(self.b), self.offset, reach, self.scratch)


def test_a_vertex_of_the_difference_is_its_farthest_and_knows_its_two_points(rng) -> None:
    difference = interpreted(gjk.make_difference(SPEC))
    for _ in range(20):
        bodies = Bodies(rng, 1.0)
        centre = vector(bodies.a[0])
        p, q = (vertices_of(each) - centre for each in bodies.solids)
        every = (p[:, None] - q[None]).reshape(-1, 3)
        direction = rng.normal(size=3)
        new = bodies.scratch.simplex[gjk.NEW_VERTEX]
        hulls = bodies.scratch.hulls
        difference(row(bodies.a), row(bodies.b), bodies.offset, Vec3(*direction), hulls, new)
        expected = every[np.argmax(every @ direction)]
        np.testing.assert_allclose(vector(new), expected, atol=1e-14)
        np.testing.assert_allclose(vector(new, "a") - vector(new, "b"), expected, atol=1e-14)
        np.testing.assert_allclose(p[np.argmax(p @ direction)], vector(new, "a"), atol=1e-14)


def test_apart_the_normal_bounds_the_distance_from_below_and_the_witnesses_from_above(rng) -> None:
    seen = 0
    for _ in range(60):
        bodies = Bodies(rng, rng.uniform(0.9, 3.0))
        status, count = bodies.walk()
        if status == gjk.OVERLAPPING:
            continue
        assert status == gjk.APART
        assert 1 <= count <= 3
        seen += 1
        found = bodies.scratch.separation[0]
        n, distance = vector(found, "n"), found.distance
        of_a, of_b = vector(found, "a"), vector(found, "b")
        assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-12)
        lower = solids.separation_along(*bodies.solids, n)
        # GAP is of the square: the distance is right to half of it and to round-off.
        assert distance == pytest.approx(lower, abs=1e-12 * bodies.size)
        np.testing.assert_allclose(of_b - of_a, distance * n, atol=1e-12 * bodies.size)
        centre = vector(bodies.a[0])
        for shape, point in zip(bodies.solids, (of_a, of_b), strict=True):
            assert solids.off_surface(shape, centre + point) <= 1e-12
    assert seen > 30


def test_overlapping_the_simplex_holds_the_origin(rng) -> None:
    for _ in range(40):
        bodies = Bodies(rng, rng.uniform(0.0, 0.3))
        status, count = bodies.walk()
        assert status == gjk.OVERLAPPING
        assert count == 4
        corners = np.array([vector(bodies.scratch.simplex[k]) for k in range(4)])
        weights = np.linalg.solve(np.vstack([corners.T, np.ones(4)]), [0.0, 0.0, 0.0, 1.0])
        assert weights.min() >= -1e-12


def test_who_is_farther_than_the_reach_is_left_early_and_who_is_not_is_found(rng) -> None:
    for _ in range(30):
        bodies = Bodies(rng, rng.uniform(1.5, 3.0))
        assert bodies.walk()[0] == gjk.APART
        distance = bodies.scratch.separation[0].distance
        assert bodies.walk(0.99 * distance)[0] == gjk.FARTHER
        assert bodies.walk(1.01 * distance)[0] == gjk.APART
        assert bodies.scratch.separation[0].distance == distance


@pytest.mark.parametrize("gap", [0.0, 1e-13])
def test_faces_that_touch_to_round_off_overlap(gap: float) -> None:
    a, b = body("box", (0.5, 0.5, 0.5)), body("box", (0.5, 0.5, 0.5), (0.2, 0.1, 1.0 + gap))
    kernel, scratch = interpreted(gjk.make_gjk(spec_of("box_box"))), scratch_of([])
    status, _ = kernel(row(a), row(b), Vec3(0.2, 0.1, 1.0 + gap), ANYWHERE, scratch)
    assert status == gjk.OVERLAPPING


def test_concentric_bodies_overlap_and_begin_in_some_direction() -> None:
    a, b = body("box", (0.5, 0.4, 0.3)), body("box", (0.2, 0.2, 0.2))
    kernel, scratch = interpreted(gjk.make_gjk(spec_of("box_box"))), scratch_of([])
    assert kernel(row(a), row(b), Vec3(0.0, 0.0, 0.0), ANYWHERE, scratch)[0] == gjk.OVERLAPPING


def test_rounds_that_run_out_are_counted_once_each(rng, monkeypatch) -> None:
    bodies = Bodies(rng, 3.0)
    assert bodies.walk()[0] == gjk.APART
    assert bodies.scratch.not_converged[0].gjk == 0
    monkeypatch.setattr(gjk, "ROUNDS", 1)
    for calls in (1, 2):
        assert bodies.walk()[0] == gjk.APART
        assert bodies.scratch.not_converged[0].gjk == calls


def test_a_vertex_is_known_by_all_its_coordinates() -> None:
    scratch = scratch_of([])
    is_known, rows = interpreted(gjk.is_known), scratch.simplex
    for k, place in enumerate([(1, 2, 3), (4, 5, 6)]):
        rows[k].x, rows[k].y, rows[k].z = place
    new = rows[gjk.NEW_VERTEX]
    for place, count, known in [
        ((4, 5, 6), 2, True), ((4, 5, 6), 1, False), ((9, 5, 6), 2, False), ((4, 9, 6), 2, False),
        ((4, 5, 9), 2, False),
    ]:  # fmt: skip
        new.x, new.y, new.z = place
        assert is_known(rows, count) is known
