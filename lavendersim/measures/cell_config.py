"""The resolved config of a cell in (a nested dict); bodies, gravity and numerics as numbers out.

Nothing here reads what a run recorded: closed forms stand on this module alone, so they are
independent of the engine. Mass properties: sphere 2/5 m r^2; box m/12 (b^2 + c^2) about each axis.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from lavendersim.measures.views import Floats

GRAVITY = 9.81  # [m/s^2]


@dataclass(frozen=True)
class BodyConfig:
    """One body as configured: SI units, world frame, `rotation` takes body to world."""

    name: str
    shape: Mapping[str, Any]
    mass: float  # [kg], 0 for a body that never moves
    position: Floats  # [m]
    rotation: Floats  # 3 x 3
    velocity: Floats  # [m/s]
    angular_velocity: Floats  # [rad/s]
    restitution: float
    compliance: float  # [m/N]

    @property
    def movable(self) -> bool:
        """False for planes and fixed bodies."""
        return self.mass > 0.0

    @property
    def inverse_mass(self) -> float:
        """1/mass [1/kg], 0 for a body that never moves."""
        return 1.0 / self.mass if self.movable else 0.0

    @property
    def inverse_inertia(self) -> Floats:
        """Inverse inertia in the world frame [1/(kg m^2)]; zero for a body that never moves."""
        if not self.movable:
            return np.zeros((3, 3))
        if self.shape["kind"] == "sphere":
            principal = np.full(3, 0.4 * self.mass * self.shape["radius"] ** 2)
        else:
            squares = np.square(np.asarray(self.shape["size"], dtype=float))
            principal = self.mass / 12.0 * (squares.sum() - squares)
        inverse: Floats = self.rotation @ np.diag(1.0 / principal) @ self.rotation.T
        return inverse

    @property
    def normal(self) -> Floats:
        """Unit normal of a plane."""
        normal = np.asarray(self.shape.get("normal", (0.0, 0.0, 1.0)), dtype=float)
        unit: Floats = normal / math.sqrt(float(normal @ normal))
        return unit

    @property
    def offset(self) -> float:
        """n . x of a plane's points [m]."""
        return float(self.shape.get("offset", 0.0))

    def extent(self, direction: Floats, rotation: Floats | None = None) -> float:
        """Distance [m] from the centre to the surface's furthest point along a unit direction."""
        if self.shape["kind"] == "sphere":
            return float(self.shape["radius"])
        turn = self.rotation if rotation is None else rotation
        half = 0.5 * np.asarray(self.shape["size"], dtype=float)
        return float(half @ np.abs(turn.T @ direction))


def body(resolved: Mapping[str, Any], name: str) -> BodyConfig:
    """Return one body of a resolved config; KeyError when there is none of that name."""
    entry = resolved["scene"]["bodies"][name]
    surface = entry.get("surface") or {}
    return BodyConfig(
        name=name,
        shape=entry["shape"],
        mass=_mass(entry),
        position=_vector(entry.get("position")),
        rotation=rotation_matrix(entry.get("orientation") or (1.0, 0.0, 0.0, 0.0)),
        velocity=_vector(entry.get("velocity")),
        angular_velocity=_vector(entry.get("angular_velocity")),
        restitution=float(surface.get("restitution", 0.0)),
        compliance=float(surface.get("compliance", 0.0)),
    )


def bodies(resolved: Mapping[str, Any]) -> tuple[BodyConfig, ...]:
    """Return all bodies of a resolved config, in its order."""
    return tuple(body(resolved, name) for name in resolved["scene"]["bodies"])


def gravity(resolved: Mapping[str, Any]) -> Floats:
    """Return the gravity vector [m/s^2]."""
    return _vector(resolved["scene"]["gravity"])


def numerics(resolved: Mapping[str, Any], name: str) -> float:
    """Return one number of the numerics; `1/480` is read as a ratio."""
    return float(Fraction(resolved["numerics"][name]))


def rotation_matrix(quaternion: Any) -> Floats:
    """Return the matrix (body to world) of a quaternion w x y z."""
    w, x, y, z = np.asarray(quaternion, dtype=float) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _mass(entry: Mapping[str, Any]) -> float:
    if entry.get("fixed") or entry["shape"]["kind"] == "plane":
        return 0.0
    return float(entry["mass"])


def _vector(value: Any) -> Floats:
    return np.zeros(3) if value is None else np.asarray(value, dtype=float)
