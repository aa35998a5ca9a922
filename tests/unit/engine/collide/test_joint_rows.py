"""Rows of a joint: phi = n . (x_B - x_A) half way between its ends, or at B's."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted, records
from single_bodies import row, scratch_of

from lavendersim.engine.collide.joint import (
    ABOUT,
    ALONG,
    DIRECTIONS,
    FIRST_JOINT,
    FIRST_ROW,
    LOWER,
    ROWS,
    UPPER,
    direction_of,
    is_couple,
    is_motor,
    is_stop,
    make_joint,
    number_of,
    put_ends,
)
from lavendersim.engine.collide.narrow_phase import make_manifold
from lavendersim.engine.collide.rope import make_count_connections
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs
from lavendersim.engine.records import ROPE
from lavendersim.engine.spec import Spec

SPEC = Spec(("compound", "frictionless_contact", "joint"), ("sphere_sphere",))
START, APART, NUMBER = np.array([0.1, -0.2, 0.3]), np.array([0.02, -0.03, 0.05]), 5
# Columns of the end on A: those of a turn about z by 3-4-5, then about x by 5-12-13.
FRAME = (
    np.array([[13, 0, 0], [0, 5, -12], [0, 12, 5]])
    / 13.0
    @ np.array([[3, -4, 0], [4, 3, 0], [0, 0, 5]])
    / 5.0
)


def end(place: np.ndarray):
    rows = allocate_bodies(SPEC, 1)
    rows["x"], rows["y"], rows["z"] = place
    rows["hy"] = NUMBER
    for i, j in np.ndindex(3, 3):
        rows[f"r{i}{j}"] = FRAME[i, j]
    return row(rows)


def kind_of(which: int, direction: int) -> int:
    return FIRST_ROW - (DIRECTIONS * which + direction)


@pytest.mark.parametrize("axis", range(3))
def test_each_row_has_the_distance_of_the_ends_along_its_axis(axis: int) -> None:
    scratch = scratch_of([])
    joint = interpreted(make_joint(SPEC))
    assert joint(kind_of(axis, axis), end(START), end(START + APART), 0.0, scratch) == 1
    point = scratch.manifold.points.array[0]
    assert point["phi"] == pytest.approx(APART[axis], abs=1e-16)
    np.testing.assert_array_equal(scratch.manifold.normal, np.eye(3)[axis])
    np.testing.assert_allclose([point[a] for a in "xyz"], START + 0.5 * APART, atol=1e-16)
    assert point["feature"] == FIRST_JOINT + ROWS * NUMBER + axis


@pytest.mark.parametrize(
    ("direction", "column", "slides"), [(3, 0, 0), (4, 1, 0), (6, 0, 1), (7, 1, 1)]
)
def test_directions_of_its_own_are_those_of_the_end_on_a(
    direction: int, column: int, slides: int
) -> None:
    scratch = scratch_of([])
    one, other = end(START), end(START + APART)
    assert interpreted(make_joint(SPEC))(kind_of(5, direction), one, other, 0.0, scratch) == 1
    point = scratch.manifold.points.array[0]
    np.testing.assert_array_equal(scratch.manifold.normal, FRAME[:, column])
    assert point["phi"] == pytest.approx(FRAME[:, column] @ APART, abs=1e-16)
    # Where ends slide, both bodies are pushed at B's.
    at = START + (APART if slides else 0.5 * APART)
    np.testing.assert_allclose([point[a] for a in "xyz"], at, atol=1e-16)
    assert point["feature"] == FIRST_JOINT + ROWS * NUMBER + 5
    contact, still = SimpleNamespace(), end(np.zeros(3))
    interpreted(put_ends)(contact, kind_of(5, direction), one, other, still, still)
    assert contact.sliding == slides
    arm = [contact.arm_ax, contact.arm_ay, contact.arm_az]
    np.testing.assert_array_equal(arm, START + APART if slides else START)
    free = [contact.free_x, contact.free_y, contact.free_z]
    np.testing.assert_array_equal(free, slides * FRAME[:, 2])


def test_kind_and_feature_say_which_row_it_is() -> None:
    found = [interpreted(direction_of)(kind_of(which, 7 - which)) for which in range(8)]
    assert found == [7 - which for which in range(8)]
    number = interpreted(number_of)
    assert [number(FIRST_JOINT + ROWS * k + 2) for k in (0, 7)] == [1, 8]


def test_manifolds_of_its_pairs_are_made_beyond_any_margin() -> None:
    manifold, scratch = interpreted(make_manifold(SPEC, SPEC.shape_pairs)), scratch_of([])
    assert manifold(FIRST_ROW, end(START), end(START + 9.0), 1e-9, scratch) == 1
    pairs = allocate_pairs(SPEC, 4)
    pairs["kind"] = [kind_of(2, 2), ROPE, 0, FIRST_ROW]
    assert interpreted(make_count_connections(SPEC))(records(pairs)) == 2


DRIVEN = Spec((*SPEC.effects, "joint_stop", "motor"), SPEC.shape_pairs)
LOW, HIGH, SIZE = -2.0, 3.5, 0.25  # [rad], [m]


def limited(low: float, high: float, moved: np.ndarray):
    one, other = end(START), end(START + FRAME @ moved)
    one.hx, other.hx = low, high
    return one, other


def turned(angle: float) -> np.ndarray:
    return SIZE * np.array([math.cos(angle), math.sin(angle), 0.4])


@pytest.mark.parametrize("angle", [-2.1, -1.9, 0.3, 3.0, 3.4, 3.6])
def test_stops_of_a_hinge_count_its_angle_beyond_half_a_turn(angle: float) -> None:
    """phi is the arc left to the limit, n the tangent along which it opens."""
    stop, one, other = interpreted(make_joint(DRIVEN)), *limited(LOW, HIGH, turned(angle))
    tangent = FRAME @ [-math.sin(angle), math.cos(angle), 0.0]
    for which, sign, left in ((LOWER, 1.0, angle - LOW), (UPPER, -1.0, HIGH - angle)):
        scratch = scratch_of([])
        assert stop(kind_of(5, ABOUT + which), one, other, 10.0, scratch) == 1
        point = scratch.manifold.points.array[0]
        assert point["phi"] == pytest.approx(SIZE * left, abs=1e-14)
        np.testing.assert_allclose(scratch.manifold.normal, sign * tangent, atol=1e-15)
        # Both bodies are pushed at the end on B.
        np.testing.assert_array_equal([point[a] for a in "xyz"], [other.x, other.y, other.z])
        assert point["feature"] == FIRST_JOINT + ROWS * NUMBER + 5
        near = stop(kind_of(5, ABOUT + which), one, other, SIZE * left - 1e-9, scratch_of([]))
        assert near == 0  # it has none beyond the margin


def test_stops_of_a_slider_count_its_way_along_the_axis() -> None:
    one, other = limited(-0.1, 0.3, np.array([0.02, -0.05, 0.12]))
    for which, sign, left in ((LOWER, 1.0, 0.22), (UPPER, -1.0, 0.18)):
        scratch = scratch_of([])
        kind = kind_of(6, ALONG + which)
        assert interpreted(make_joint(DRIVEN))(kind, one, other, 1.0, scratch) == 1
        assert scratch.manifold.points.array[0]["phi"] == pytest.approx(left, abs=1e-15)
        np.testing.assert_array_equal(scratch.manifold.normal, sign * FRAME[:, 2])


def test_a_motor_that_turns_has_a_couple_for_levers_and_no_normal() -> None:
    one, other = limited(0.0, 0.0, turned(0.7))
    still, joint = end(np.zeros(3)), interpreted(make_joint(DRIVEN))
    found = {}
    for direction in (ABOUT, ALONG):
        scratch, contact = scratch_of([]), SimpleNamespace()
        assert joint(kind_of(5, direction), one, other, 0.0, scratch) == 1
        assert scratch.manifold.points.array[0]["phi"] == 0.0
        interpreted(put_ends)(contact, kind_of(5, direction), one, other, still, still)
        arms = [[contact.__dict__[f"arm_{b}{axis}"] for axis in "xyz"] for b in "ab"]
        found[direction] = np.array(scratch.manifold.normal), np.array(arms)
    # 1 m long, wherever its ends are.
    np.testing.assert_array_equal(found[ABOUT][0], 0.0)
    np.testing.assert_allclose(found[ABOUT][1], [FRAME[:, 2]] * 2, atol=1e-16)
    np.testing.assert_array_equal(found[ALONG][0], FRAME[:, 2])
    np.testing.assert_array_equal(found[ALONG][1], [[other.x, other.y, other.z]] * 2)


def test_directions_of_stops_and_motors_are_known() -> None:
    found = {
        direction: [
            interpreted(ask)(kind_of(3, direction)) for ask in (is_motor, is_couple, is_stop)
        ]
        for direction in range(DIRECTIONS)
    }
    assert [direction for direction, one in found.items() if one[0]] == [ABOUT, ALONG]
    assert [direction for direction, one in found.items() if one[1]] == [ABOUT]
    stops = [direction for direction, one in found.items() if one[2]][:4]
    assert stops == [ABOUT + LOWER, ABOUT + UPPER, ALONG + LOWER, ALONG + UPPER]
