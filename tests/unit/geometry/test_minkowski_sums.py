"""Many solids' extents by one formula are those of each solid by its own."""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.cell.shapes import Box, Capsule, Cylinder, Sphere
from lavendersim.geometry.minkowski_sums import extents, sums_of
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from tests.made_cells import MadeShape

SOLIDS = (
    Sphere(kind="sphere", radius=0.3),
    Box(kind="box", size=(0.2, 0.5, 0.9)),
    Capsule(kind="capsule", radius=0.2, length=0.7),
    Cylinder(kind="cylinder", radius=0.4, length=0.3),
)
TURN = rotation_matrix(unit_quaternion([0.7, 0.1, -0.4, 0.3]))


def test_each_reaches_as_far_as_its_shape_says() -> None:
    sums = sums_of(SOLIDS)
    turns = np.broadcast_to(TURN, (len(SOLIDS), 3, 3))
    for direction in np.eye(3):
        x, y, z = (TURN.T @ direction).tolist()
        alone = [solid.extent((x, y, z)) for solid in SOLIDS]
        # n_z is some 0.7 at most here, so no root has lost digits.
        assert extents(sums, turns, direction) == pytest.approx(alone, rel=4e-15)


def test_what_is_no_such_sum_reaches_without_end() -> None:
    sums = sums_of([MadeShape(), SOLIDS[0]])  # type: ignore[list-item]
    reach = extents(sums, np.stack([TURN, TURN]), np.array([0.0, 0.0, 1.0]))
    assert reach.tolist() == [np.inf, 0.3]


def test_no_solid_at_all() -> None:
    none = extents(sums_of([]), np.empty((0, 3, 3)), np.array([1.0, 0.0, 0.0]))
    assert none.shape == (0,)
