"""Overlap from geometry, against hulls of Minkowski differences, sampled axes and simple scenes."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from synthetic import contacts, log_of, scene_of

from lavendersim.cell.shapes import PRIMITIVES, Cone, Ellipsoid, Primitive
from lavendersim.cell.shapes.box import Box
from lavendersim.cell.shapes.capsule import Capsule
from lavendersim.cell.shapes.cylinder import Cylinder
from lavendersim.cell.shapes.sphere import Sphere
from lavendersim.geometry.minkowski_sums import extents, sums_of
from lavendersim.geometry.rotations import rotation_matrices as rotations
from lavendersim.geometry.shapes import extent
from lavendersim.measures import evaluate
from lavendersim.measures.penetration import (
    box_box,
    capsule_capsule,
    sphere_box,
    sphere_capsule,
    sphere_sphere,
)
from lavendersim.measures.solids import PlacedSolids, near_pairs
from lavendersim.measures.specs.overlap import Overlap

SEED = 20
CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
BALL = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0}
CUBE = {"shape": {"kind": "box", "size": [0.2, 0.2, 0.2]}, "mass": 1.0}
FLOOR = {"shape": {"kind": "plane", "normal": [0.0, 0.0, 1.0], "offset": 0.0}}


def placed(rng: np.random.Generator, count: int, spread: float) -> PlacedSolids:
    return PlacedSolids(
        rng.uniform(-spread, spread, (count, 3)),
        rotations(rng.normal(size=(count, 4))),
        rng.uniform(0.1, 0.5, (count, 3)),
    )


def hull_depth(a: PlacedSolids, b: PlacedSolids, index: int) -> float:
    """Least distance from the origin to a face of the hull of all differences of corners."""
    one, other = (
        (CORNERS * box.size[index]) @ box.rotation[index].T + box.position[index] for box in (a, b)
    )
    hull = ConvexHull((one[:, None] - other[None]).reshape(-1, 3))
    return float(np.min(-hull.equations[:, 3]))


def test_boxes_overlap_by_the_least_distance_to_their_minkowski_difference() -> None:
    rng = np.random.default_rng(SEED)
    a, b = placed(rng, 300, 0.3), placed(rng, 300, 0.3)
    found = box_box(a, b)
    expected = np.array([hull_depth(a, b, index) for index in range(300)])
    inside = expected > 0.0
    assert 50 < np.count_nonzero(inside) < 290
    # qhull merges faces closer than about 1e-13 of the hull's size of 2 m
    np.testing.assert_allclose(found[inside], expected[inside], atol=1e-12)
    assert np.all(found[~inside] <= 0.0)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-9, 1e-7, 1e-4])
def test_boxes_nearly_face_to_face_overlap_by_the_depth_of_the_deepest_corner(tilt: float) -> None:
    # half edges 0.1 m, centres 0.2 m - 1 um apart, the upper box turned by `tilt` about x: its
    # lowest edge lies 0.1 (cos + sin - 1) lower
    turn = np.array([[math.cos(tilt / 2), math.sin(tilt / 2), 0.0, 0.0]])
    lower = PlacedSolids(
        np.zeros((1, 3)), rotations(np.array([[1.0, 0, 0, 0]])), np.full((1, 3), 0.1)
    )
    upper = PlacedSolids(np.array([[0.0, 0.0, 0.2 - 1e-6]]), rotations(turn), np.full((1, 3), 0.1))
    depth = 1e-6 + 0.1 * (math.cos(tilt) + math.sin(tilt) - 1.0)
    # an edge product of length 1e-9 to 1e-4 divides round-off of 1e-17 m; below 1e-8 it is left out
    assert box_box(lower, upper)[0] == pytest.approx(depth, abs=2e-9)


def test_boxes_edge_to_edge_need_the_product_of_their_edges() -> None:
    # both stand on an edge, crossed: sqrt(2) 0.1 from centre to edge, 0.01 m of overlap
    reach = 0.1 * math.sqrt(2.0)
    half = math.pi / 8.0
    quaternions = np.array([[math.cos(half), math.sin(half), 0.0, 0.0]])
    lower = PlacedSolids(np.zeros((1, 3)), rotations(quaternions), np.full((1, 3), 0.1))
    crossed = np.array([[math.cos(half), 0.0, math.sin(half), 0.0]])
    upper = PlacedSolids(
        np.array([[0.0, 0.0, 2.0 * reach - 0.01]]), rotations(crossed), np.full((1, 3), 0.1)
    )
    assert box_box(lower, upper)[0] == pytest.approx(0.01, abs=1e-15)


@pytest.mark.parametrize("angle", [1e-2, 1e-4, 1e-6])
def test_edges_that_cross_at_a_small_angle_still_decide_the_depth(angle: float) -> None:
    # edge to edge along x, the upper box turned about the line through both edges' middles: the
    # edges cross there, and for depths below 0.1 m times the angle no face is nearer
    across = np.array([0.0, 1.0, 1.0]) * math.sqrt(0.5)
    depth = 0.01 * angle
    turned = np.array([[math.cos(angle / 2), *(math.sin(angle / 2) * across)]])
    lower = PlacedSolids(
        np.zeros((1, 3)), rotations(np.array([[1.0, 0, 0, 0]])), np.full((1, 3), 0.1)
    )
    place = np.array([[0.0, 0.2, 0.2]]) - depth * across
    upper = PlacedSolids(place, rotations(turned), np.full((1, 3), 0.1))
    # sums of some 0.3 m with round-off of 1e-16 m, over a product of edges as long as the angle
    assert box_box(lower, upper)[0] == pytest.approx(depth, abs=1e-15 + 3e-16 / angle)


def test_a_sphere_inside_a_box_leaves_by_the_nearest_face() -> None:
    box = PlacedSolids(
        np.zeros((3, 3)), rotations(np.tile([1.0, 0, 0, 0], (3, 1))), np.full((3, 3), 0.5)
    )
    centres = np.array([[0.0, 0.0, 0.45], [0.0, 0.6, 0.0], [0.8, 0.9, 0.0]])
    sphere = PlacedSolids(centres, box.rotation, np.full((3, 3), 0.2))
    # 0.05 m from a face inside; 0.1 m outside; 0.5 m from an edge
    np.testing.assert_allclose(sphere_box(sphere, box), [0.25, 0.1, -0.3], atol=1e-15)


def test_capsules_against_sampled_axes() -> None:
    rng = np.random.default_rng(SEED)
    a, b = placed(rng, 60, 0.4), placed(rng, 60, 0.4)
    shares = np.linspace(-1.0, 1.0, 801)
    for index, depth in enumerate(capsule_capsule(a, b)):
        axes = [
            one.position[index] + shares[:, None] * one.size[index, 2] * one.rotation[index, :, 2]
            for one in (a, b)
        ]
        squared = ((axes[0][:, None] - axes[1][None]) ** 2).sum(axis=2)
        radii = a.size[index, 0] + b.size[index, 0]
        # samples h = 1.25 mm apart lie within h/2 of the nearest points of both axes
        assert radii - math.sqrt(squared.min()) <= depth + 1e-15
        assert radii - math.sqrt(squared.min()) >= depth - 1.3e-3


def test_parallel_and_crossing_capsules() -> None:
    upright = rotations(np.tile([1.0, 0, 0, 0], (3, 1)))
    lying = rotations(np.tile([math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0], (3, 1)))
    size = np.tile([0.1, 0.0, 0.5], (3, 1))
    a = PlacedSolids(np.zeros((3, 3)), upright, size)
    beside = PlacedSolids(np.array([[0.15, 0, 0.3], [0.0, 0, 1.1], [0.3, 0, 1.4]]), upright, size)
    # side by side; end to end; ends 0.3 m across and 0.4 m apart along
    np.testing.assert_allclose(capsule_capsule(a, beside), [0.05, 0.1, -0.3], atol=1e-15)
    across = PlacedSolids(np.array([[0, 0.15, 0.2], [0.6, 0.1, 0.0], [0, 0, 0.65]]), lying, size)
    expected = [0.05, 0.2 - math.hypot(0.1, 0.1), 0.05]
    np.testing.assert_allclose(capsule_capsule(a, across), expected, atol=1e-15)
    ball = PlacedSolids(np.array([[0.15, 0, 0.4], [0, 0, 0.65], [0.4, 0, 0.8]]), upright, size)
    np.testing.assert_allclose(sphere_capsule(ball, a), [0.05, 0.05, -0.3], atol=1e-15)


def shape_of(kind: int, size: np.ndarray) -> Primitive:
    """Return one of four solids that holds a ball as thick as the least of three half lengths."""
    x, y, z = size.tolist()
    return (
        Sphere(kind="sphere", radius=x),
        Box(kind="box", size=(2 * x, 2 * y, 2 * z)),
        Capsule(kind="capsule", radius=x, length=2 * z),
        Cylinder(kind="cylinder", radius=x, length=2 * z),
    )[kind]


def test_a_solid_reaches_as_far_as_its_shape_says() -> None:
    """The shape's own extent is of one direction; here it is a Minkowski sum, many at once."""
    rng = np.random.default_rng(SEED)
    scene = placed(rng, 80, 1.0)
    shapes = [shape_of(k % 4, size) for k, size in enumerate(scene.size)]
    # An ellipsoid or a cone is no such sum: how far they reach is unknown; nothing is culled.
    assert {type(shape) for shape in shapes} == set(PRIMITIVES) - {Ellipsoid, Cone}
    smooth = sums_of([Ellipsoid(kind="ellipsoid", semi_axes=(0.1, 0.2, 0.3))])
    assert extents(smooth, scene.rotation[:1], np.array([0.0, 0.0, 1.0])).tolist() == [math.inf]
    for direction in rotations(rng.normal(size=(5, 4)))[:, 0]:
        expected = [
            extent(shape, turn, direction)
            for shape, turn in zip(shapes, scene.rotation, strict=True)
        ]
        # sums of a few numbers below 1 m; sqrt(1 - n_z^2) loses digits where a cylinder stands,
        # by eps / sqrt(1 - n_z^2), 1e-14 for the nearest of these directions
        np.testing.assert_allclose(
            extents(sums_of(shapes), scene.rotation, direction), expected, atol=1e-14
        )


@pytest.mark.parametrize("stretch", [(1, 1, 1), (0.1, 0.1, 8), (9, 0.2, 0.2)])
def test_the_cull_loses_no_pair_that_overlaps(stretch: tuple[float, float, float]) -> None:
    rng = np.random.default_rng(SEED)
    count = 120
    scene = placed(rng, count, 1.0)
    scene = scene._replace(position=scene.position * stretch, size=0.4 * scene.size)
    shapes = [shape_of(int(rng.integers(4)), size) for size in scene.size]
    movable = rng.random(count) < 0.8
    first, second = near_pairs(sums_of(shapes), scene, movable)
    assert len(set(zip(first, second, strict=True))) == len(first)
    kept = {frozenset(pair) for pair in zip(first.tolist(), second.tolist(), strict=True)}
    everyone = [pair for pair in itertools.combinations(range(count), 2) if any(movable[[*pair]])]
    a, b = (scene.take([pair[side] for pair in everyone]) for side in (0, 1))
    # balls of the bodies' thinnest size lie inside every kind
    thin = [one._replace(size=one.size.min(axis=1)[:, None]) for one in (a, b)]
    touching = [
        pair for pair, depth in zip(everyone, sphere_sphere(*thin), strict=True) if depth > 0
    ]
    assert touching
    assert all(frozenset(pair) in kept for pair in touching)
    assert len(kept) < len(everyone) / 2


def stacked(gaps: list[float]) -> object:
    """A cube on a floor and a ball on the cube, both sunk in by these depths, one row each."""
    rows = [[(0, 0, 0), (0, 0, 0.1 - gap), (0, 0, 0.3 - 3 * gap)] for gap in gaps]
    return log_of(scene_of({"floor": FLOOR, "cube": CUBE, "ball": BALL}), rows)


def test_the_deepest_pair_of_the_last_window_counts() -> None:
    log = stacked([0.04, 0.01, 0.003, 0.001, 0.002])
    spec = Overlap(kind="overlap", last=0.02)
    # the ball sinks twice as deep into the cube as the cube into the floor
    assert evaluate(spec, log) == pytest.approx(0.004, abs=1e-16)
    assert evaluate(spec.model_copy(update={"last": 0.03}), log) == pytest.approx(0.006, abs=1e-16)


def test_a_stride_counts_back_from_the_last_row() -> None:
    log = stacked([0.0, 0.04, 0.001, 0.04, 0.002])
    assert evaluate(Overlap(kind="overlap", last=0.04, every=2), log) == pytest.approx(
        0.004, abs=1e-16
    )


def test_bodies_apart_overlap_by_exactly_nothing() -> None:
    assert evaluate(Overlap(kind="overlap", last=0.01), stacked([-0.01, -0.01])) == 0.0


def test_the_solvers_word_is_not_taken() -> None:
    log = stacked([0.0, 0.002])
    log.contact = contacts([(1, 1.0, 0.5)])
    assert evaluate(Overlap(kind="overlap", last=0.01), log) == pytest.approx(0.004, abs=1e-16)


def test_a_window_longer_than_the_run_has_no_answer() -> None:
    assert math.isnan(evaluate(Overlap(kind="overlap", last=1.0), stacked([0.0, 0.0])))


@pytest.mark.parametrize(("height", "known"), [(0.6, True), (0.25, False)])
def test_shapes_without_a_closed_form_are_unknown_only_when_they_come_close(
    height: float, known: bool
) -> None:
    can = {"shape": {"kind": "cylinder", "radius": 0.1, "length": 0.2}, "mass": 1.0}
    scene = scene_of({"floor": FLOOR, "cube": CUBE, "can": can})
    log = log_of(scene, [[(0, 0, 0), (0, 0, 0.1), (0, 0, height)]] * 2)
    assert math.isnan(evaluate(Overlap(kind="overlap", last=0.01), log)) is not known


@pytest.mark.parametrize(
    ("shape", "depth"),
    [
        ({"kind": "capsule", "radius": 0.1, "length": 0.4}, 0.1 + 0.2 * math.sqrt(0.5)),
        ({"kind": "cylinder", "radius": 0.1, "length": 0.4}, 0.3 * math.sqrt(0.5)),
        ({"kind": "box", "size": [0.2, 0.2, 0.4]}, 0.3 * math.sqrt(0.5)),
    ],
)
def test_tilted_solids_on_a_plane(shape: dict[str, object], depth: float) -> None:
    half = math.pi / 8.0
    turned = [math.cos(half), math.sin(half), 0.0, 0.0]
    scene = scene_of({"floor": FLOOR, "rod": {"shape": shape, "mass": 1.0}})
    log = log_of(scene, [[(0, 0, 0), (0, 0, 0.0)]] * 2, [[[1, 0, 0, 0], turned]] * 2)
    assert evaluate(Overlap(kind="overlap", last=0.01), log) == pytest.approx(depth, abs=1e-15)
