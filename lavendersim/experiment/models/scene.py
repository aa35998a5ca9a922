"""The `scene` of a config as written: gravity, surfaces, bodies, arrangements and forces."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, Tag

from lavendersim.cell.surface import Surface
from lavendersim.engine.effects import SCENE_KEYS
from lavendersim.experiment.models.arrangements import Arrangement
from lavendersim.experiment.models.bodies import Body
from lavendersim.quantities.model import ConfigModel, declared
from lavendersim.quantities.names import BodyName, NewName
from lavendersim.quantities.quantity import Quantity, Vector, Vector3, either

GRAVITY = 9.81  # [m/s^2]


class TiltedGravity(ConfigModel):
    """Gravity by its angle from -z: a flat floor is an incline that goes down along the azimuth."""

    magnitude: Annotated[float, Quantity("m/s^2", minimum=0)] = Field(
        default=GRAVITY, description="[m/s^2]"
    )
    tilt_degrees: Annotated[float, Quantity("degree", minimum=0, maximum=180)] | None = Field(
        default=None, description="[degree] angle from -z; not stated: 0, or by the slope"
    )
    slope: Annotated[float, Quantity(minimum=0)] | None = Field(
        default=None, description="tangent of that angle, instead of tilt_degrees"
    )
    azimuth_degrees: Annotated[float, Quantity("degree")] = Field(
        default=0.0, description="[degree] from x towards y: the direction in which it goes down"
    )


def _gravity_form(value: Any) -> str:
    if isinstance(value, dict):
        return "tilted"
    return "vector" if isinstance(value, list | tuple) else "magnitude"


Gravity = Annotated[
    Annotated[
        float,
        Quantity("m/s^2", minimum=0, hint="a number is the magnitude along -z"),
        Tag("magnitude"),
    ]
    | Annotated[Vector3, Vector(3, Quantity("m/s^2")), Tag("vector")]
    | Annotated[TiltedGravity, Tag("tilted")],
    either("a number, a list of 3 numbers [m/s^2] or {slope: ...}", _gravity_form),
]

_ZERO = (0.0, 0.0, 0.0)


class Force(ConfigModel):
    """A force and a torque on one body, constant for a while; those of one body add."""

    body: BodyName = Field(description="name of a movable body")
    begin: Annotated[float, Quantity("s", minimum=0)] = Field(
        default=0.0, alias="from", description="[s] acts from the first step that starts then"
    )
    end: Annotated[float, Quantity("s", minimum=0)] | None = Field(
        default=None,
        alias="to",
        description="[s] until the first step that starts then; not stated: to the end of the run",
    )
    force: Annotated[Vector3, Vector(3, Quantity("N"))] = Field(
        default=_ZERO, description="[N] on the centre of mass, world frame"
    )
    torque: Annotated[Vector3, Vector(3, Quantity("N m"))] = Field(
        default=_ZERO, description="[N m] world frame, right-handed"
    )


class Scene(declared("Scene", ConfigModel, SCENE_KEYS)):  # type: ignore[misc]
    """What is there; bodies in the order in which they are written, then those arranged."""

    gravity: Gravity = Field(
        default=GRAVITY,
        description="[m/s^2] magnitude along -z, a vector [gx, gy, gz], or its tilt",
    )
    surfaces: dict[NewName, Surface] = Field(
        default={}, description="named surfaces, shared by bodies"
    )
    bodies: dict[NewName, Body] = Field(description="name of the body: its properties")
    arrangements: dict[NewName, Arrangement] = Field(
        default={}, description="name: one body in many places; they are called name_1, name_2, ..."
    )
    forces: tuple[Force, ...] = Field(default=(), description="forces and torques over time")


__all__ = ["GRAVITY", "Body", "Force", "Gravity", "Scene", "Surface", "TiltedGravity"]
