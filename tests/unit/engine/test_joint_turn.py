"""Levers of joints: r_1 - r_0 = dt w x (r_0 + r_1)/2 of the turn that bodies make, to round-off."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from interpreted import interpreted
from single_bodies import row

from lavendersim.engine.integrate import LASTING
from lavendersim.engine.joint_turn import make_joint_velocity, make_turned_apart, mean_lever
from lavendersim.engine.record_layout import allocate_bodies
from lavendersim.engine.rotation import half_turn, turn
from lavendersim.engine.spec import Spec
from lavendersim.engine.vectors import Vec3

EFFECTS = ("compound", "contact_torque", "frictionless_contact", "joint", "rotation")
SPEC = Spec(EFFECTS)
CENTRED = SPEC.including("contact_midpoint", "midpoint")
DT, ARM = 0.1, np.array([0.3, -0.4, 0.7])
SPIN = np.array([3.0, -2.0, 5.0])  # 0.62 rad in the step
NAMES = [f"{body}{axis}" for body in "ab" for axis in "xyz"]


def body() -> np.recarray:
    rows = allocate_bodies(SPEC, 1)
    q = np.array([0.5, -0.1, 0.7, 0.2])
    rows["qw"], rows["qx"], rows["qy"], rows["qz"] = q / np.linalg.norm(q)
    interpreted(turn)(row(rows), 0.0, 0.0, 0.0)
    return row(rows)


def matrix(one) -> np.ndarray:
    return np.array([[getattr(one, f"r{i}{j}") for j in range(3)] for i in range(3)])


def placed(one) -> np.ndarray:
    return matrix(one) @ ARM


def test_mean_lever_is_that_of_both_ends_of_the_turn() -> None:
    start, half, end = body(), body(), body()
    interpreted(half_turn)(half, *SPIN, DT)
    interpreted(turn)(end, *(DT * SPIN))
    found = np.array(interpreted(mean_lever)(half, start, Vec3(*placed(half))))
    np.testing.assert_allclose(found, 0.5 * (placed(start) + placed(end)), atol=1e-15)
    np.testing.assert_allclose(placed(end) - placed(start), DT * np.cross(SPIN, found), atol=1e-15)


def contact(arm_a: np.ndarray, arm_b: np.ndarray, n: np.ndarray) -> SimpleNamespace:
    arms = {f"arm_{name}": x for name, x in zip(NAMES, [*arm_a, *arm_b], strict=True)}
    normal = dict(zip(("nx", "ny", "nz"), n, strict=True))
    free = dict.fromkeys(("free_x", "free_y", "free_z"), 0.0)
    return SimpleNamespace(a=0, b=1, lasts=1, sliding=0, **arms, **normal, **free)


def moving(velocity: np.ndarray, spin: np.ndarray, **more: float) -> SimpleNamespace:
    names = ("vx", "vy", "vz", "wx", "wy", "wz")
    return SimpleNamespace(**dict(zip(names, [*velocity, *spin], strict=True)), **more)


def test_velocity_of_a_joint_is_that_of_its_points() -> None:
    other = np.array([-0.2, 0.1, 0.5])
    one = contact(ARM, other, np.eye(3)[0])
    va, vb = np.array([1.0, 2.0, 3.0]), np.array([-2.0, 0.5, 1.0])
    velocity = interpreted(make_joint_velocity(SPEC))
    found = velocity(one, moving(va, SPIN), moving(vb, -2.0 * SPIN))
    expected = vb - 2.0 * np.cross(SPIN, other) - va - np.cross(SPIN, ARM)
    np.testing.assert_allclose(np.array(found), expected, atol=1e-14)


@pytest.mark.parametrize("side", [0, 1])
def test_a_row_of_the_start_leaves_what_the_turn_adds_to_its_rate(side: int) -> None:
    start, end = body(), body()
    interpreted(turn)(end, *(DT * SPIN))
    left = placed(end) - placed(start) - DT * np.cross(SPIN, placed(start))
    arms, spins = [np.zeros(3), np.zeros(3)], [np.zeros(3), np.zeros(3)]
    arms[side], spins[side] = placed(start), SPIN
    velocities = [moving(np.zeros(3), spin) for spin in spins]
    still = [SimpleNamespace(tau=DT, midway=0, carried=0) for _ in range(2)]
    for axis in range(3):
        one = contact(arms[0], arms[1], np.eye(3)[axis])
        found = interpreted(make_turned_apart(CENTRED))(one, velocities, still, DT)
        assert found == pytest.approx((2 * side - 1) * left[axis], abs=1e-15)


def test_velocity_of_a_joint_is_without_that_along_which_its_ends_slide() -> None:
    one = contact(ARM, ARM, np.eye(3)[0])
    one.free_x, one.free_z = 0.6, 0.8
    v = np.array([1.0, 2.0, 3.0])
    found = interpreted(make_joint_velocity(SPEC))(one, moving(0 * v, 0 * v), moving(v, 0 * v))
    free = np.array([0.6, 0.0, 0.8])
    np.testing.assert_allclose(np.array(found), v - (free @ v) * free, atol=1e-15)


def test_a_row_across_a_slider_leaves_what_its_turning_direction_adds() -> None:
    """n_1 . e_1 - n . e, both bodies turning and moving, less dt times the row's velocity."""
    start, end_a, end_b = body(), body(), body()
    other = np.array([2.0, 1.0, -4.0])
    interpreted(turn)(end_a, *(DT * SPIN))
    interpreted(turn)(end_b, *(DT * other))
    turns = [matrix(end) @ matrix(start).T for end in (end_a, end_b)]
    n, r, e = np.array([0.6, 0.0, 0.8]), np.array([0.2, -0.5, 0.1]), np.array([1.0, 0.3, -0.2])
    va, vb = np.array([1.0, 2.0, 3.0]), np.array([-1.0, 0.5, 2.0])
    later = e + DT * (vb - va) + turns[1] @ r - r
    rate = n @ (vb + np.cross(other, r) - va - np.cross(SPIN, e))
    expected = (turns[0] @ n) @ later - n @ e - DT * rate
    one = contact(e, r, n)
    one.sliding = 1
    still = [SimpleNamespace(tau=DT, midway=0, carried=0) for _ in range(2)]
    velocities = [moving(va, SPIN), moving(vb, other)]
    found = interpreted(make_turned_apart(CENTRED))(one, velocities, still, DT)
    assert found == pytest.approx(expected, abs=1e-14)


def test_rows_at_the_middle_and_in_an_impact_leave_nothing_and_lasting_ones_by_their_mean() -> None:
    turned_apart = interpreted(make_turned_apart(CENTRED))
    one = contact(ARM, np.zeros(3), np.eye(3)[1])
    velocities = [moving(np.zeros(3), SPIN), moving(np.zeros(3), np.zeros(3))]

    def left(**more: float) -> float:
        known = {"tau": DT, "midway": 0, "carried": 0} | more
        return turned_apart(one, velocities, [moving(np.zeros(3), -SPIN, **known)] * 2, DT)

    assert left() != 0.0
    assert left(midway=1) == 0.0
    assert left(tau=0.5 * DT) == 0.0
    # By the mean of a spin and its opposite nothing of A turns; B ends without one, from -SPIN.
    assert left(carried=LASTING) == pytest.approx(0.0, abs=1e-15)
