"""The separation is the largest s(n): face normals are exact, and `ascend` ends at a summit."""

from __future__ import annotations

import convex
import numpy as np
import pytest
import solids
from interpreted import interpreted
from scipy.optimize import minimize
from scipy.spatial import ConvexHull
from single_bodies import body, hull, row, scratch_of, solid, spec_of, vector, vertices_of

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.convex import separation
from lavendersim.engine.vectors import Vec3

EVERYWHERE = 1e9


def separate(pair: str, a, b, hulls=(), reach: float = EVERYWHERE):
    """Return (whether it is within reach, scratch)."""
    scratch = scratch_of(list(hulls))
    offset = Vec3(*(vector(b[0]) - vector(a[0])))
    kernel = interpreted(separation.make_separate(spec_of(pair)))
    return kernel(row(a), row(b), offset, reach, scratch), scratch


def summit(a, b, rng) -> float:
    """Return the largest s(n) that a search without derivatives finds from many directions."""

    def negative(angles):
        theta, phi = angles
        n = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        return -solids.separation_along(a, b, n)

    starts = sorted(rng.uniform((0.0, 0.0), (np.pi, 2 * np.pi), (400, 2)), key=negative)[:6]
    options = {"xatol": 1e-10, "fatol": 1e-13, "maxfev": 2000}
    return max(-minimize(negative, s, method="Nelder-Mead", options=options).fun for s in starts)


def test_s_of_n_is_the_gap_of_the_supports(rng) -> None:
    along = interpreted(separation.make_separation_along(spec_of("cylinder_box")))
    for _ in range(40):
        a = body("box", rng.uniform(0.2, 0.6, 3), rng.normal(size=3), convex.random_rotation(rng))
        b = body("cylinder", (0.3, 0.0, 0.5), rng.normal(size=3), convex.random_rotation(rng))
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        offset = Vec3(*(vector(b[0]) - vector(a[0])))
        found = along(row(a), row(b), offset, Vec3(*n), scratch_of([]).hulls)
        assert found == pytest.approx(solids.separation_along(solid(a), solid(b), n), abs=1e-14)


def test_polyhedra_have_their_distance_or_depth(rng) -> None:
    """Overlapping: the least height of a face of A - B. Apart: s(n), and as far the witnesses."""
    apart = 0
    for _ in range(40):
        a = body("box", rng.uniform(0.2, 0.6, 3), rng.normal(size=3), convex.random_rotation(rng))
        centre = vector(a[0]) + rng.uniform(0.1, 0.8) * rng.normal(size=3)
        b, hulls = hull(rng.normal(size=(10, 3)) * 0.4, centre, convex.random_rotation(rng))
        within, scratch = separate("hull_box", a, b, hulls)
        assert within
        found, both = scratch.separation[0], (solid(a), solid(b, hulls))
        size = float(a["bound"][0] + b["bound"][0])
        p, q = map(vertices_of, both)
        height = float(-ConvexHull((p[:, None] - q[None]).reshape(-1, 3)).equations[:, 3].max())
        proved = solids.separation_along(*both, vector(found, "n"))
        assert found.distance == pytest.approx(proved, abs=1e-12 * size)
        if height > 0.0:
            # A face's own normal is taken where it separates less by 1e-10 of the sizes at most.
            assert -height - 2 * separation.FACE_SHARE * size <= found.distance <= -height + 1e-12
        else:
            apart += 1
            way = vector(found, "b") - vector(found, "a")
            assert np.linalg.norm(way) == pytest.approx(found.distance, abs=3e-10 * size)
    assert 8 < apart < 32


@pytest.mark.parametrize("kinds", ["cylinder_box", "cylinder_cylinder"])
def test_round_bodies_that_overlap_have_the_depth_that_no_direction_near_beats(kinds, rng) -> None:
    for _ in range(4):
        b = body("cylinder", (0.4, 0.0, 0.3), 0.3 * rng.normal(size=3), convex.random_rotation(rng))
        a = body("box", (0.3, 0.2, 0.4), matrix=convex.random_rotation(rng))
        if kinds == "cylinder_cylinder":
            a = body("cylinder", (0.3, 0.0, 0.5), matrix=convex.random_rotation(rng))
        _, scratch = separate(kinds, a, b)
        found, both = scratch.separation[0], (solid(a), solid(b))
        best = summit(*both, rng)
        size = float(a["bound"][0] + b["bound"][0])
        proved = solids.separation_along(*both, vector(found, "n"))
        assert found.distance == pytest.approx(proved, abs=1e-12)
        assert found.distance <= best + 1e-9 * size
        # Two summits may be as high to EPA's share of the depth; the search may have the other.
        assert found.distance >= best - (1e-3 * abs(best) + 1e-5 * size)
        again = interpreted(separation.make_ascend(spec_of(kinds)))
        before = found.distance
        again(row(a), row(b), Vec3(*(vector(b[0]) - vector(a[0]))), scratch)
        assert found.distance == pytest.approx(before, abs=1e-9 * size)


def test_a_standing_cylinder_askew_by_less_than_the_share_has_the_exact_normal() -> None:
    """The face separates less by a share of the sizes: sin 1e-11 times the radius."""
    matrix = convex.matrix_of([1.0, 0.5e-11, 0.0, 0.0])
    a = body("box", (1.0, 1.0, 0.5))
    for kind, half in (("cylinder", (0.3, 0.0, 0.4)), ("box", (0.3, 0.3, 0.4))):
        pair = "box_box" if kind == "box" else "cylinder_box"
        _, scratch = separate(pair, a, body(kind, half, (0.1, 0.2, 0.9 - 1e-6), matrix))
        found = scratch.separation[0]
        np.testing.assert_array_equal(vector(found, "n"), (0.0, 0.0, 1.0))
        assert found.distance == pytest.approx(-1e-6, abs=1e-11)


def test_a_cap_of_b_on_an_edge_of_a_gives_its_exact_normal(rng) -> None:
    """The world is turned: GJK and EPA end at round-off of the normal, the cap's has none."""
    for _ in range(5):
        world = convex.random_rotation(rng)
        edge_up = world @ convex.matrix_of([np.cos(np.pi / 8), np.sin(np.pi / 8), 0.0, 0.0])
        a = body("box", (0.5, 0.5, 0.5), matrix=edge_up)
        height = np.sqrt(0.5) + 0.4 - 1e-4
        b = body("cylinder", (0.3, 0.0, 0.4), height * world[:, 2], world)
        _, scratch = separate("cylinder_box", a, b)
        np.testing.assert_array_equal(vector(scratch.separation[0], "n"), world[:, 2])


def test_what_is_beyond_the_reach_is_left(rng) -> None:
    a, b = body("box", (0.5, 0.5, 0.5)), body("box", (0.5, 0.5, 0.5), (0.1, 0.0, 1.3))
    assert not separate("box_box", a, b, reach=0.299)[0]
    assert separate("box_box", a, b, reach=0.301)[0]


def distance_of(pair: str, a, b, hulls=()):
    kernel = interpreted(separation.make_separation(spec_of(pair)))
    distance, n = kernel(SHAPE_PAIRS[pair].kind, row(a), row(b), scratch_of(list(hulls)))
    return distance, np.array(n)


def test_the_true_distance_counts_radii_and_planes(rng) -> None:
    """A capsule and a sphere by the axis; a plane by the lowest point; overlapping cores: less."""
    capsule, ball = body("capsule", (0.2, 0.0, 0.5)), body("sphere", (0.3, 0, 0), (0.7, 0.0, 0.1))
    distance, n = distance_of("sphere_capsule", capsule, ball)
    assert distance == pytest.approx(0.2, abs=1e-14)
    np.testing.assert_allclose(n, (1.0, 0.0, 0.0), atol=1e-14)
    distance, n = distance_of("sphere_capsule", capsule, body("sphere", (0.3, 0, 0), (0, 0, 0.4)))
    assert (distance, *n) == (-0.5, 0.0, 0.0, 0.0)
    normal = np.array([2.0, -1.0, 2.0]) / 3.0
    plane = body("plane", normal, offset=0.3)
    for kind, half in (
        ("sphere", (0.4, 0, 0)),
        ("capsule", (0.2, 0, 0.5)),
        ("box", (0.2, 0.3, 0.4)),
    ):
        lying = body(kind, half, rng.normal(size=3), convex.random_rotation(rng))
        distance, n = distance_of(f"{kind}_plane", plane, lying)
        assert distance == pytest.approx(-solids.reach(solid(lying), -normal) - 0.3, abs=1e-14)
        np.testing.assert_array_equal(n, normal)
