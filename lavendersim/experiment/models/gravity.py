"""Gravity as written: a number along -z, a vector, or its tilt."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from lavendersim.experiment.text.place import Place
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Either, Quantity, Vector, Vector3

GRAVITY = 9.81  # [m/s^2]


class TiltedGravity(ConfigModel):
    """Gravity by its angle from -z: a flat floor is an incline that goes down along the azimuth."""

    magnitude: Annotated[float, Quantity("m/s^2", minimum=0)] = Field(
        default=GRAVITY, description="[m/s^2]"
    )
    tilt_degrees: Annotated[float, Quantity("degree", minimum=0, maximum=180)] | None = Field(
        default=None,
        description="[degree] angle from -z; 0 where neither this nor `slope` is given",
    )
    slope: Annotated[float, Quantity(minimum=0)] | None = Field(
        default=None, description="tangent of that angle, instead of `tilt_degrees`"
    )
    azimuth_degrees: Annotated[float, Quantity("degree")] = Field(
        default=0.0, description="[degree] from x towards y: the direction in which it goes down"
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """An angle is written once."""
        tilt, slope = at.written("tilt_degrees"), at.written("slope")
        if tilt and slope:
            at.refuse(max(tilt, slope), "gravity specifies both tilt_degrees and slope; keep one")


Gravity = Annotated[
    Annotated[Vector3, Vector(3, Quantity("m/s^2"))]
    | TiltedGravity
    | Annotated[float, Quantity("m/s^2", minimum=0, hint="a number is the magnitude along -z")],
    Either("a number, a list of 3 numbers [m/s^2] or {slope: ...}", tuple, dict, object),
]
