"""A mesh is as large as its farthest triangle, has no other side and no extent; it never yields."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell import CellMesh
from lavendersim.geometry.shapes import bounding_radius, extent, pieces, thickness

MESH = CellMesh(
    kind="mesh",
    vertices=((0, 0, 0), (3, 0, 0), (3, 4, 0), (90, 0, 0)),  # no triangle has the last one
    triangles=((0, 1, 2),),
)


def test_a_mesh_is_as_large_as_its_triangles_and_has_no_end() -> None:
    assert bounding_radius(MESH) == 5.0
    assert thickness(MESH) == math.inf
    assert pieces(MESH) == ()
    with pytest.raises(ValueError, match="a mesh has no extent"):
        extent(MESH, np.eye(3), np.array([0.0, 0.0, 1.0]))
