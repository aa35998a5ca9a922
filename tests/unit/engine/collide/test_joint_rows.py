"""Rows of a joint: phi = n . (x_B - x_A) along each axis, half way between its ends."""

from __future__ import annotations

import numpy as np
import pytest
from interpreted import interpreted, records
from single_bodies import row, scratch_of

from lavendersim.engine.collide.joint import (
    FIRST_AXIS,
    FIRST_JOINT,
    ROWS,
    axis_of,
    make_joint,
    number_of,
)
from lavendersim.engine.collide.narrow_phase import make_manifold
from lavendersim.engine.collide.rope import ROPE, make_count_connections
from lavendersim.engine.record_layout import allocate_bodies, allocate_pairs
from lavendersim.engine.spec import Spec

SPEC = Spec(("compound", "frictionless_contact", "joint"), ("sphere_sphere",))
START, APART, NUMBER = np.array([0.1, -0.2, 0.3]), np.array([0.02, -0.03, 0.05]), 5


def end(place: np.ndarray):
    rows = allocate_bodies(SPEC, 1)
    rows["x"], rows["y"], rows["z"] = place
    rows["hy"] = NUMBER
    return row(rows)


@pytest.mark.parametrize("axis", range(3))
def test_each_row_has_the_distance_of_the_ends_along_its_axis(axis: int) -> None:
    scratch = scratch_of([])
    joint = interpreted(make_joint(SPEC))
    assert joint(FIRST_AXIS - axis, end(START), end(START + APART), scratch) == 1
    point = scratch.manifold.points.array[0]
    assert point["phi"] == pytest.approx(APART[axis], abs=1e-16)
    np.testing.assert_array_equal(scratch.manifold.normal, np.eye(3)[axis])
    np.testing.assert_allclose([point[a] for a in "xyz"], START + 0.5 * APART, atol=1e-16)
    assert point["feature"] == FIRST_JOINT + ROWS * NUMBER + axis


def test_kind_and_feature_say_which_row_it_is() -> None:
    assert [interpreted(axis_of)(FIRST_AXIS - axis) for axis in range(3)] == [0, 1, 2]
    number = interpreted(number_of)
    assert [number(FIRST_JOINT + ROWS * k + 2) for k in (0, 7)] == [1, 8]


def test_manifolds_of_its_pairs_are_made_beyond_any_margin() -> None:
    manifold, scratch = interpreted(make_manifold(SPEC, SPEC.shape_pairs)), scratch_of([])
    assert manifold(FIRST_AXIS, end(START), end(START + 9.0), 1e-9, scratch) == 1
    pairs = allocate_pairs(SPEC, 4)
    pairs["kind"] = [FIRST_AXIS - 2, ROPE, 0, FIRST_AXIS]
    assert interpreted(make_count_connections(SPEC))(records(pairs)) == 2
