"""A shape and its mass enter; mass and principal moments of inertia leave. SI units."""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple


class MassProperties(NamedTuple):
    """Mass [kg] and principal moments about the centre of mass, body axes [kg m^2]."""

    mass: float
    inertia: tuple[float, float, float]


def mass_properties(shape: dict[str, Any], mass: float) -> MassProperties:
    """Return the properties of a homogeneous solid of this mass [kg]."""
    m = float(mass)
    if shape["kind"] == "sphere":
        i = 0.4 * m * float(shape["radius"]) ** 2
        return MassProperties(m, (i, i, i))
    sx, sy, sz = (float(edge) for edge in shape["size"])
    return MassProperties(
        m,
        (
            m / 12.0 * (sy * sy + sz * sz),
            m / 12.0 * (sx * sx + sz * sz),
            m / 12.0 * (sx * sx + sy * sy),
        ),
    )


def bounding_radius(shape: dict[str, Any]) -> float:
    """Return the radius of the sphere about the centre that holds the shape [m]; planes: inf."""
    if shape["kind"] == "plane":
        return float("inf")
    if shape["kind"] == "sphere":
        return float(shape["radius"])
    sx, sy, sz = shape["size"]
    return 0.5 * sqrt(sx * sx + sy * sy + sz * sz)
