"""Depths of overlap by hand, for each pair of kinds that has a closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.measures.penetration import depths
from lavendersim.measures.solids import BOX, CAPSULE, CYLINDER, SPHERE, PlacedSolids

STRAIGHT = np.eye(3)
HALF_TURN = math.pi / 4.0


def placed(size: list[float], place: list[float], turn: np.ndarray = STRAIGHT) -> PlacedSolids:
    """Return one solid."""
    return PlacedSolids(np.array([place], float), turn[None], np.array([size], float))


def about(axis: int, angle: float) -> np.ndarray:
    """Return a turn about an axis."""
    quaternion = np.array([math.cos(0.5 * angle), 0.0, 0.0, 0.0])
    quaternion[1 + axis] = math.sin(0.5 * angle)
    return rotation_matrix(unit_quaternion(quaternion))


def depth(kind_a: int, a: PlacedSolids, kind_b: int, b: PlacedSolids) -> float:
    """Return the depth of a pair, the same in both orders."""
    (one,), (other,) = depths(kind_a, kind_b, a, b), depths(kind_b, kind_a, b, a)
    assert one == pytest.approx(other, abs=1e-15)
    return float(one)


BALL = placed([0.5, 0.0, 0.0], [0.0, 0.0, 0.0])


@pytest.mark.parametrize(("distance", "overlap"), [(0.8, 0.2), (1.0, 0.0), (1.3, -0.3)])
def test_balls_overlap_by_their_radii_less_their_distance(distance: float, overlap: float) -> None:
    other = placed([0.5, 0.0, 0.0], [0.6 * distance, 0.0, 0.8 * distance])
    assert depth(SPHERE, BALL, SPHERE, other) == pytest.approx(overlap, abs=1e-15)


def test_ball_at_a_corner_and_within_a_box() -> None:
    box = placed([1.0, 1.0, 2.0], [0.0, 0.0, 0.0])
    at_corner = placed([0.5, 0.0, 0.0], [1.2, 1.2, 2.1])  # 0.2, 0.2, 0.1 beyond it: 0.3 away
    assert depth(SPHERE, at_corner, BOX, box) == pytest.approx(0.2, abs=1e-15)
    within = placed([0.5, 0.0, 0.0], [0.0, 0.7, 0.0])  # 0.3 below the nearest face
    assert depth(SPHERE, within, BOX, box) == pytest.approx(0.8, abs=1e-15)


def test_ball_beside_and_beyond_a_capsules_end() -> None:
    capsule = placed([0.2, 0.0, 1.0], [0.0, 0.0, 0.0])
    beside = placed([0.5, 0.0, 0.0], [0.6, 0.0, 0.9])
    beyond = placed([0.5, 0.0, 0.0], [0.3, 0.0, 1.4])  # 0.5 from the end of the axis
    assert depth(SPHERE, beside, CAPSULE, capsule) == pytest.approx(0.1, abs=1e-15)
    assert depth(SPHERE, beyond, CAPSULE, capsule) == pytest.approx(0.2, abs=1e-15)


def test_crossed_parallel_and_collinear_capsules() -> None:
    one = placed([0.2, 0.0, 1.0], [0.0, 0.0, 0.0])
    crossed = placed([0.1, 0.0, 1.0], [0.0, 0.25, 0.5], about(1, 2.0 * HALF_TURN))
    beside = placed([0.1, 0.0, 1.0], [0.25, 0.0, 1.5])
    behind = placed([0.1, 0.0, 1.0], [0.0, 0.0, 2.5])
    assert depth(CAPSULE, one, CAPSULE, crossed) == pytest.approx(0.05, abs=1e-15)
    assert depth(CAPSULE, one, CAPSULE, beside) == pytest.approx(0.05, abs=1e-15)
    assert depth(CAPSULE, one, CAPSULE, behind) == pytest.approx(-0.2, abs=1e-15)


def test_boxes_face_to_face_edge_to_face_and_edge_to_edge() -> None:
    cube = placed([1.0, 1.0, 1.0], [0.0, 0.0, 0.0])
    above = placed([1.0, 1.0, 1.0], [0.3, 0.0, 1.9])
    assert depth(BOX, cube, BOX, above) == pytest.approx(0.1, abs=1e-15)
    on_edge = placed([1.0, 1.0, 1.0], [0.0, 0.0, 1.0 + math.sqrt(2.0) - 0.1], about(0, HALF_TURN))
    assert depth(BOX, cube, BOX, on_edge) == pytest.approx(0.1, abs=1e-14)
    # Two cubes on edges that cross at right angles: sqrt(2) each along z.
    low = placed([1.0, 1.0, 1.0], [0.0, 0.0, 0.0], about(0, HALF_TURN))
    high = placed([1.0, 1.0, 1.0], [0.0, 0.0, 2.0 * math.sqrt(2.0) - 0.1], about(1, HALF_TURN))
    assert depth(BOX, low, BOX, high) == pytest.approx(0.1, abs=1e-14)


def test_a_pair_without_a_closed_form_has_no_number() -> None:
    cylinder = placed([0.2, 0.0, 1.0], [0.0, 0.0, 0.0])
    assert math.isnan(depths(SPHERE, CYLINDER, BALL, cylinder)[0])
