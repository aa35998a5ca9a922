"""How large and how thin a shape is, against numbers anyone can check."""

from __future__ import annotations

import math

import pytest

from lavendersim.measures.extent import bounding_radius, thickness

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
    "plane": ({"kind": "plane"}, 0.0, math.inf),
}


@pytest.mark.parametrize("name", SHAPES)
def test_radius_and_thickness(name: str) -> None:
    shape, radius, width = SHAPES[name]
    assert bounding_radius(shape) == pytest.approx(radius)
    assert thickness(shape) == pytest.approx(width)
