"""The resolved config of a cell in (a nested dict); bodies, gravity and numerics as numbers out.

Nothing here reads what a run recorded: closed forms stand on this module alone, so they are
independent of the engine. Moments of inertia are those of the resolved config; where it has none,
sphere 2/5 m r^2; box m/12 (b^2 + c^2) about each axis.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
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
    friction: float = 0.0
    inertia: tuple[float, ...] | None = None  # moments about the axes of its frame [kg m^2]

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
        inverse: Floats = self.rotation @ np.diag(1.0 / self.principal_inertia) @ self.rotation.T
        return inverse

    @property
    def principal_inertia(self) -> Floats:
        """Moments about the body's own axes [kg m^2]."""
        if self.inertia is not None:
            return np.array(self.inertia, dtype=float)
        if self.shape["kind"] == "box":
            squares = np.square(np.asarray(self.shape["size"], dtype=float))
            moments: Floats = self.mass / 12.0 * (squares.sum() - squares)
            return moments
        return np.full(3, 0.4 * self.mass * float(self.shape["radius"]) ** 2)

    @property
    def radius(self) -> float:
        """Distance from the centre to the farthest point of the surface [m]."""
        if self.shape["kind"] == "box":
            return 0.5 * math.sqrt(sum(float(edge) ** 2 for edge in self.shape["size"]))
        half = 0.5 * float(self.shape.get("length", 0.0))
        radius = float(self.shape["radius"])
        return math.hypot(radius, half) if self.shape["kind"] == "cylinder" else radius + half

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
        if self.shape["kind"] in ("capsule", "cylinder"):
            slope = min(1.0, abs(float(turn[:, 2] @ direction)))
            round_part = 1.0 if self.shape["kind"] == "capsule" else math.sqrt(1.0 - slope * slope)
            half_length = 0.5 * float(self.shape["length"])
            return float(self.shape["radius"]) * round_part + half_length * slope
        half = 0.5 * np.asarray(self.shape["size"], dtype=float)
        return float(half @ np.abs(turn.T @ direction))

    def lowest(self, normal: Floats) -> Floats:
        """Point of the surface farthest against a unit direction [m]; the middle of a flat side."""
        reach = np.zeros(3)
        along = self.rotation.T @ normal
        along[np.abs(along) < 1e-14] = 0.0  # a side at right angles, but for round-off
        if self.shape["kind"] == "box":
            reach = 0.5 * np.asarray(self.shape["size"], dtype=float) * np.sign(along)
        elif self.shape["kind"] in ("capsule", "cylinder"):
            reach[2] = 0.5 * float(self.shape["length"]) * float(np.sign(along[2]))
        rounded = np.zeros(3)
        if self.shape["kind"] in ("sphere", "capsule"):
            rounded = float(self.shape["radius"]) * along
        elif self.shape["kind"] == "cylinder":
            across = along * (1.0, 1.0, 0.0)
            length = math.sqrt(float(across @ across))
            rounded = float(self.shape["radius"]) * across / length if length else across
        point: Floats = self.position - self.rotation @ (reach + rounded)
        return point


def body(resolved: Mapping[str, Any], name: str) -> BodyConfig:
    """Return one body of a resolved config; KeyError when there is none of that name."""
    entry = resolved["scene"]["bodies"][name]
    surface = entry.get("surface") or {}
    return BodyConfig(
        name=name,
        shape=entry["shape"],
        mass=_mass(entry),
        position=_vector(entry.get("position")),
        rotation=rotation_matrix(unit_quaternion(entry.get("orientation") or (1.0, 0.0, 0.0, 0.0))),
        velocity=_vector(entry.get("velocity")),
        angular_velocity=_vector(entry.get("angular_velocity")),
        restitution=float(surface.get("restitution", 0.0)),
        compliance=float(surface.get("compliance", 0.0)),
        friction=float(surface.get("friction", 0.0)),
        inertia=entry.get("inertia"),
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


def _mass(entry: Mapping[str, Any]) -> float:
    if entry.get("fixed") or entry["shape"]["kind"] == "plane":
        return 0.0
    return float(entry["mass"])


def _vector(value: Any) -> Floats:
    return np.zeros(3) if value is None else np.asarray(value, dtype=float)
