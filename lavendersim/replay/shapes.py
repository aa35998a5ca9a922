"""A resolved config enters; the geometry of its bodies leaves, each in its own frame."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
XYZW = [1, 2, 3, 0]  # of a quaternion w x y z: the order that rerun takes
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


class Piece(NamedTuple):
    """One convex solid: its shape as resolved, and where it stands in the body."""

    shape: Mapping[str, Any]
    position: Vector  # [m]
    quaternion: Vector  # w x y z

    @property
    def kind(self) -> str:
        """Name of the shape."""
        return str(self.shape["kind"])

    @property
    def reach(self) -> float:
        """Largest distance [m] of the piece's surface from the centre of its body."""
        return float(np.linalg.norm(self.position)) + _radius(self.shape)


class Shape(NamedTuple):
    """One body's geometry: a plane, or pieces."""

    name: str
    kind: str
    fixed: bool
    pieces: tuple[Piece, ...]
    normal: Vector
    offset: float

    @property
    def reach(self) -> float:
        """Largest distance [m] of the body's surface from its centre."""
        return max((piece.reach for piece in self.pieces), default=0.0)


def shapes(resolved: Mapping[str, Any]) -> list[Shape]:
    """Geometry of every body of a resolved config, in its order."""
    return [_shape(name, body) for name, body in resolved["scene"]["bodies"].items()]


def _shape(name: str, body: Mapping[str, Any]) -> Shape:
    given = body["shape"]
    kind = given["kind"]
    fixed = kind == "plane" or bool(body.get("fixed", False))
    if kind == "plane":
        direction = np.array(given["normal"], dtype=np.float64)
        normal = direction / np.linalg.norm(direction)
        return Shape(name, kind, fixed, (), normal, float(given["offset"]))
    pieces = tuple(
        Piece(part["shape"], _floats(part["position"]), _floats(part["orientation"]))
        for part in given.get("parts", ())
    )
    return Shape(name, kind, fixed, pieces or (Piece(given, np.zeros(3), UPRIGHT),), UP, 0.0)


def _floats(values: Any) -> Vector:
    return np.array(values, dtype=np.float64)


def _radius(shape: Mapping[str, Any]) -> float:
    """Return the radius [m] of the sphere about its centre that holds a solid."""
    kind = shape["kind"]
    if kind == "box":
        return 0.5 * math.hypot(*shape["size"])
    if kind == "hull":
        return max(math.hypot(*point) for point in shape["points"])
    radius, half = float(shape["radius"]), 0.5 * float(shape.get("length", 0.0))
    return math.hypot(radius, half) if kind == "cylinder" else radius + half
