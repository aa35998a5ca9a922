"""A validated config of one cell in; the same with every default filled in out.

Surfaces stand in place, density has become mass, a release has become a position, the preset has
become numbers. This is what is simulated, hashed and written into the log.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from lavendersim.experiment.models import CellSource, Event, NumericsChange, Window
from lavendersim.experiment.placement import released_position, rotation_quaternion, unit
from lavendersim.experiment.presets import PRESETS, PresetValue
from lavendersim.experiment.quantities import Quantity, Vector3
from lavendersim.experiment.run_checks import whole_steps
from lavendersim.experiment.scene_models import (
    AxisAngle,
    Body,
    Box,
    Plane,
    Release,
    Scene,
    Sphere,
    Surface,
)


class _Resolved(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class CellBody(_Resolved):
    """One body, ready to be built."""

    shape: Plane | Sphere | Box
    fixed: bool
    mass: float | None  # [kg]; None for a fixed body
    density: float | None  # [kg/m^3] as written
    surface: Surface
    position: Vector3  # [m] centre of mass; of a plane: its point nearest to the origin
    release: Release | None  # as written; `position` follows from it
    orientation: tuple[float, float, float, float]  # unit quaternion w x y z, body to world
    velocity: Vector3  # [m/s]
    angular_velocity: Vector3  # [rad/s]


class CellScene(_Resolved):
    """Gravity and the bodies, in the order of the file."""

    gravity: Vector3  # [m/s^2]
    bodies: dict[str, CellBody]


class CellEvent(_Resolved):
    """One change to a body, applied before the first step that starts at `at` or later."""

    at: float  # [s]
    body: str
    scale_mass: float | None
    teleport: Vector3 | None  # [m]
    contact_cache: Literal["keep", "clear"]


class Numerics(_Resolved):
    """Every number of the numerics; see `docs/config.md` for their meaning."""

    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)]  # [s]
    solver: str
    sweeps: int
    tolerance: float | None  # [m/s]
    warm_start: bool
    stabilisation_gain: float
    slop: float  # [m]
    projection: float
    projection_sweeps: int
    restitution_threshold: float  # [g dt]
    cache_distance: float  # [m]
    cache_normal_cosine: float


class ResidualWindow(_Resolved):
    """A stretch of simulated time [s]."""

    begin: float = Field(alias="from")
    end: float = Field(alias="to")


class CellRecord(_Resolved):
    """What is logged beyond every step."""

    residuals: Literal["none", "all"] | ResidualWindow


class CellConfig(_Resolved):
    """One cell of an experiment, complete."""

    scene: CellScene
    events: tuple[CellEvent, ...]
    numerics: Numerics
    duration: float  # [s]
    record: CellRecord

    @property
    def steps(self) -> int:
        """The whole number of steps nearest to duration / timestep."""
        return whole_steps(self.duration, self.numerics.timestep)

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON-able data: ratios as `1/480`, vectors as lists."""
        return self.model_dump(mode="json", by_alias=True)


def resolve_cell(source: CellSource) -> CellConfig:
    """Fill in what the file leaves to defaults; raises PlacementError for a body without a place.

    `source` has passed the checks between its values (`scene_checks`, `run_checks`).
    """
    numerics = resolve_numerics(source.numerics)
    return CellConfig(
        scene=_scene(source.scene, numerics.timestep),
        events=tuple(_event(event) for event in source.events),
        numerics=numerics,
        duration=source.duration,
        record=CellRecord(residuals=_residuals(source.record.residuals)),
    )


def resolve_numerics(stated: str | NumericsChange) -> Numerics:
    """Return the preset with the stated values in place of its own."""
    if isinstance(stated, str):
        return _numerics(PRESETS[stated])
    given = {name: getattr(stated, name) for name in stated.model_fields_set - {"preset"}}
    # null is a value for `tolerance` (never stop early) and says nothing anywhere else
    changes = {name: v for name, v in given.items() if v is not None or name == "tolerance"}
    return _numerics(PRESETS[stated.preset] | changes)


def gravity_vector(gravity: float | Vector3) -> Vector3:
    """Return gravity [m/s^2]; a number is its magnitude along -z."""
    return gravity if isinstance(gravity, tuple) else (0.0, 0.0, 0.0 - gravity)


def _numerics(values: dict[str, PresetValue]) -> Numerics:
    return Numerics.model_validate(values)


def _scene(scene: Scene, timestep: Fraction) -> CellScene:
    gravity = gravity_vector(scene.gravity)
    bodies = {
        name: _body(name, body, scene, gravity, timestep) for name, body in scene.bodies.items()
    }
    return CellScene(gravity=gravity, bodies=bodies)


def _body(name: str, body: Body, scene: Scene, gravity: Vector3, timestep: Fraction) -> CellBody:
    surface = scene.surfaces[body.surface] if isinstance(body.surface, str) else body.surface
    shape = body.shape
    fixed = body.fixed or isinstance(shape, Plane)
    if isinstance(shape, Plane):
        shape = shape.model_copy(update={"normal": unit(shape.normal)})
    orientation = (
        rotation_quaternion(body.orientation.axis, body.orientation.degrees)
        if isinstance(body.orientation, AxisAngle)
        else unit(body.orientation)
    )
    if isinstance(shape, Plane):
        position: Vector3 = _scaled(shape.normal, shape.offset)
    elif body.release is not None:
        plane = scene.bodies[body.release.above].shape
        assert isinstance(plane, Plane)
        position = released_position(
            name, body.release, plane, shape, orientation, gravity, timestep
        )
    else:
        assert body.position is not None
        position = body.position
    return CellBody.model_construct(
        shape=shape,
        fixed=fixed,
        mass=None if fixed else _mass(body),
        density=body.density,
        surface=surface,
        position=position,
        release=body.release,
        orientation=orientation,
        velocity=body.velocity,
        angular_velocity=body.angular_velocity,
    )


def _mass(body: Body) -> float:
    if body.mass is not None:
        return body.mass
    assert body.density is not None
    if isinstance(body.shape, Sphere):
        return body.density * 4.0 / 3.0 * math.pi * body.shape.radius**3
    assert isinstance(body.shape, Box)
    return body.density * math.prod(body.shape.size)


def _scaled(vector: Vector3, factor: float) -> Vector3:
    x, y, z = vector
    return (x * factor, y * factor, z * factor)


def _event(event: Event) -> CellEvent:
    kept = event.contact_cache or ("keep" if event.teleport is None else "clear")
    return CellEvent(
        at=event.at,
        body=event.body,
        scale_mass=event.scale_mass,
        teleport=event.teleport,
        contact_cache=kept,
    )


def _residuals(residuals: str | Window) -> Any:
    if isinstance(residuals, Window):
        return ResidualWindow.model_validate({"from": residuals.begin, "to": residuals.end})
    return residuals
