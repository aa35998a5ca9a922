"""What a scene is, in no engine's words: bodies, planes, gravity, one contact law, a timestep.

Friction and restitution belong to the scene, not to a body: engines mix the values of two bodies
by different rules (product, mean, least, greatest), and each adapter sets what its own rule turns
into the value asked for.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


class Sphere(NamedTuple):
    """A ball."""

    radius: float  # [m]


class Box(NamedTuple):
    """A rectangular block."""

    size: Vector  # full edge lengths [m]


class Plane(NamedTuple):
    """The half-space n.x <= offset; it never moves."""

    normal: Vector  # unit length, outward
    offset: float  # [m]


class Body(NamedTuple):
    """One body at the start. A mass of None means that it never moves."""

    shape: Sphere | Box | Plane
    mass: float | None = None  # [kg]
    position: Vector = ZERO  # centre of mass [m]
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)  # w x y z, body to world
    velocity: Vector = ZERO  # [m/s]
    angular_velocity: Vector = ZERO  # world frame [rad/s]
    principal: Vector | None = None  # inertia about the body's axes [kg m^2]; None: uniform density

    @property
    def moves(self) -> bool:
        """Whether the body has a mass."""
        return self.mass is not None

    @property
    def inertia(self) -> Vector:
        """Principal moments about the body's axes [kg m^2]."""
        assert self.mass is not None
        if self.principal is not None:
            return self.principal
        if isinstance(self.shape, Sphere):
            moment = 0.4 * self.mass * self.shape.radius**2
            return (moment, moment, moment)
        assert isinstance(self.shape, Box)
        x, y, z = (edge * edge * self.mass / 12.0 for edge in self.shape.size)
        return (y + z, x + z, x + y)


class Scene(NamedTuple):
    """Bodies under one gravity and one contact law, and for how many steps they are simulated."""

    bodies: tuple[Body, ...]
    steps: int
    timestep: Fraction = Fraction(1, 240)  # [s]
    gravity: Vector = (0.0, 0.0, -9.81)  # [m/s^2]
    friction: float = 0.0  # mu of every contact
    restitution: float = 0.0  # e of every contact

    @property
    def movable(self) -> tuple[Body, ...]:
        """Bodies that move, in the order of the rows of every track."""
        return tuple(body for body in self.bodies if body.moves)

    @property
    def fixed(self) -> tuple[Body, ...]:
        """Bodies that never move."""
        return tuple(body for body in self.bodies if not body.moves)

    def step_at(self, time: float) -> int:
        """Return the step whose end is nearest to `time` [s]."""
        return round(time / self.timestep)
