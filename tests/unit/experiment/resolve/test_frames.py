"""Vectors and orientations of a body whose principal axes are not those that the file means."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lavendersim.experiment.resolve.frames import Frames
from lavendersim.geometry.quaternions import Quaternion, axes, product, to_world
from lavendersim.geometry.vectors import unit

WRITTEN: Quaternion = unit((0.9, 0.1, -0.3, 0.2))
PRINCIPAL: Quaternion = unit((0.4, 0.5, 0.6, -0.1))  # principal axes in the frame as written
TURNED: Quaternion = unit((0.2, -0.7, 0.3, 0.5))


def frames(after: Quaternion) -> Frames:
    return Frames({"thing": WRITTEN}, {"thing": SimpleNamespace(orientation=after)})  # type: ignore[dict-item]


def test_a_vector_is_the_same_in_the_world_in_both_frames() -> None:
    resolved = product(WRITTEN, PRINCIPAL)
    found = frames(resolved).vector("thing", (1.0, 2.0, 3.0))
    expected = to_world(WRITTEN, (1.0, 2.0, 3.0))
    assert to_world(resolved, found) == pytest.approx(expected, abs=2e-14)  # forty roundings of 4


def test_a_body_turned_as_written_has_its_principal_axes_turned_along() -> None:
    """A point p of the frame as written is P^T p in the principal one: Q' P^T p is T p."""
    resolved = product(WRITTEN, PRINCIPAL)
    found = frames(resolved).orientation("thing", TURNED)
    matrix = np.array(axes(found)).T @ np.array(axes(PRINCIPAL))
    np.testing.assert_allclose(matrix, np.array(axes(TURNED)).T, atol=2e-15)


def test_a_frame_that_is_the_written_one_keeps_every_bit() -> None:
    assert frames(WRITTEN).orientation("thing", TURNED) == TURNED
    assert frames(WRITTEN).vector("thing", (0.1, 0.2, 0.3)) == (0.1, 0.2, 0.3)
