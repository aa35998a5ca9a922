"""How large and how thin a shape is, and how far it reaches, against numbers anyone can check."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell import CellBody, CellShape
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import bounding_radius, extent, half_space, thickness
from tests.oracle.cells import body

BALL = {"kind": "sphere", "radius": 0.5}
BOX = {"kind": "box", "size": [2.0, 4.0, 4.0]}
WEDGE = {"kind": "hull", "points": [[-1, 0, 0], [2, 0, 0], [0, 1, 0], [0, 0, 3]]}
SHAPES = {
    "sphere": (BALL, 0.5, 1.0),
    "box": (BOX, 3.0, 2.0),
    "capsule": ({"kind": "capsule", "radius": 0.5, "length": 2.0}, 1.5, 1.0),
    "long cylinder": ({"kind": "cylinder", "radius": 3.0, "length": 8.0}, 5.0, 6.0),
    "disc": ({"kind": "cylinder", "radius": 4.0, "length": 6.0}, 5.0, 6.0),
    "hull": (WEDGE, 3.0, 1.0),
    "compound": (
        {
            "kind": "compound",
            "parts": [
                {"shape": BALL, "position": [0.0, 3.0, 4.0], "orientation": [1, 0, 0, 0]},
                {"shape": BOX, "position": [0.0, 0.0, 0.0], "orientation": [1, 0, 0, 0]},
            ],
        },
        5.5,
        1.0,
    ),
    "plane": ({"kind": "plane"}, math.inf, math.inf),
}


def shape_of(described: dict) -> CellShape:
    return CellBody.model_validate(body({"shape": described})).shape


@pytest.mark.parametrize("name", SHAPES)
def test_radius_and_thickness(name: str) -> None:
    described, radius, width = SHAPES[name]
    shape = shape_of(described)
    assert bounding_radius(shape) == pytest.approx(radius)
    assert thickness(shape) == pytest.approx(width)


def points_of(described: dict) -> np.ndarray:
    """Many points of a shape, corners and rims among them."""
    kind = described["kind"]
    if kind == "compound":
        return np.concatenate(
            [points_of(part["shape"]) + part["position"] for part in described["parts"]]
        )
    if kind == "hull":
        return np.array(described["points"], float)
    if kind == "box":
        signs = np.array(np.meshgrid(*[(-0.5, 0.5)] * 3)).reshape(3, -1).T
        return signs * described["size"]
    turns = np.random.default_rng(4).normal(size=(200_000, 3))
    half = np.array([0.0, 0.0, 0.5 * described.get("length", 0.0)])
    turns[:, 2] *= kind != "cylinder"
    rim = described["radius"] * turns / np.linalg.norm(turns, axis=1)[:, None]
    return np.concatenate([rim + half, rim - half])


@pytest.mark.parametrize("name", [name for name in SHAPES if name != "plane"])
def test_extent_is_that_of_the_farthest_point(name: str) -> None:
    described = SHAPES[name][0]
    points, shape = points_of(described), shape_of(described)
    for row in np.random.default_rng(9).normal(size=(10, 7)):
        turn, direction = rotation_matrix(unit_quaternion(row[:4])), row[4:]
        direction = direction / np.linalg.norm(direction)
        farthest = float(np.max(points @ turn.T @ direction))
        found = extent(shape, turn, direction)
        # of 200,000 random directions the nearest is some 0.01 rad away: 1 - cos = 5e-5
        assert farthest <= found + 1e-14
        assert found == pytest.approx(farthest, rel=1e-3)


def test_a_plane_bounds_a_half_space_of_unit_normal() -> None:
    normal, offset = half_space(shape_of({"kind": "plane", "normal": [0, 3, 4], "offset": 2.0}))
    np.testing.assert_allclose(normal, [0.0, 0.6, 0.8], atol=1e-16)
    assert offset == 2.0
    with pytest.raises(ValueError, match="a sphere is no half-space"):
        half_space(shape_of(BALL))
