"""What every convex solid of a cell declares of itself: extent, mass, look, and its engine row.

A frame belongs to each: its origin is the centre of mass, its axes are principal axes. Plain floats
only, because a config is resolved with them: the same digits on every machine. Kernels stand in a
file of the same name in `engine/collide/shapes`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, ClassVar, Final, NamedTuple

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity, Vector3

Length = Annotated[float, Quantity("m", above=0)]

ROUND: Final = 20  # corners of a circle in a picture: at the size of a thumbnail none can be seen


class Homogeneous(NamedTuple):
    """What a solid of one density is about its principal axes."""

    volume: float  # [m^3]
    moments: Vector3  # [m^2] principal moments of inertia over the mass


class MinkowskiSum(NamedTuple):
    """A solid as the sum of a box, a disc across its z and a ball, all about its centre.

    h(n) = sum_i half_i |n_i| + disc sqrt(1 - n_z^2) + ball, which is one formula for many solids.
    """

    half: Vector3 = (0.0, 0.0, 0.0)  # edges of the box [m]
    disc: float = 0.0  # radius [m]
    ball: float = 0.0  # radius [m]


class Convex(ABC):
    """A convex solid in its principal frame."""

    MOST_POINTS: ClassVar[int] = 4  # contact points that it has with another body, at most
    if TYPE_CHECKING:
        kind: str

    @abstractmethod
    def bounding_radius(self) -> float:
        """Return the radius of the sphere about the centre of mass that holds it [m]."""

    @abstractmethod
    def thickness(self) -> float:
        """Return the least width along the axes of its frame [m]."""

    @abstractmethod
    def extent(self, along: Vector3) -> float:
        """Return how far it reaches from its centre along a unit direction: its support [m]."""

    @abstractmethod
    def corners(self) -> tuple[Vector3, ...]:
        """Return points [m] whose convex hull looks like it."""

    def farthest_point(self, along: Vector3) -> Vector3:
        """Return the point farthest along a unit direction, the middle of a side that lies flat.

        ValueError where there is no closed form.
        """
        raise ValueError(f"no closed form for the lowest point of a {self.kind}")

    def row(self) -> dict[str, float]:
        """Return the fields that its kernels read of a body's record (`engine.records.BODY`)."""
        return {}


class Primitive(ConfigModel, Convex):
    """A convex solid that a config gives by its dimensions."""

    @abstractmethod
    def homogeneous(self) -> Homogeneous:
        """Return volume and moments of inertia of one density."""

    def minkowski_sum(self) -> MinkowskiSum | None:
        """Return what it is the sum of; None where it is no such sum."""
        return None


def circle(radius: float, height: float) -> tuple[Vector3, ...]:
    """Return corners [m] of a circle about the z axis."""
    return _turned((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), radius, height)


def ball(radius: float, height: float) -> tuple[Vector3, ...]:
    """Return corners [m] of great circles of a ball that stands on the z axis at a height."""
    return tuple(p for one, other in _GREAT_CIRCLES for p in _turned(one, other, radius, height))


def _turned(one: Vector3, other: Vector3, radius: float, height: float) -> tuple[Vector3, ...]:
    points: list[Vector3] = []
    for k in range(ROUND):
        turn = 2.0 * math.pi * k / ROUND
        c, s = radius * math.cos(turn), radius * math.sin(turn)
        x, y, z = (c * u + s * v for u, v in zip(one, other, strict=True))
        points.append((x, y, z + height))
    return tuple(points)


_HALF: Final = math.sqrt(0.5)
# Two directions of each plane: a ball with these seven looks round from everywhere.
_GREAT_CIRCLES: Final[tuple[tuple[Vector3, Vector3], ...]] = (
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
    ((_HALF, 0.0, _HALF), (0.0, 1.0, 0.0)),
    ((_HALF, 0.0, -_HALF), (0.0, 1.0, 0.0)),
    ((1.0, 0.0, 0.0), (0.0, _HALF, -_HALF)),
    ((1.0, 0.0, 0.0), (0.0, _HALF, _HALF)),
)
