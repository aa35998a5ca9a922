"""What is simulated, hashed and logged: a config of one cell with nothing left open.

Surfaces stand in place, arrangements have become bodies, density has become mass, a release has
become a position, the preset has become numbers. A body's frame has its origin in the centre of
mass and its axes along the principal axes of its shape; poses in the log are those of this frame,
and points of hulls and parts of compounds are given in it.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from lavendersim.clock import Clock, written
from lavendersim.experiment.body_models import Drag, Release, Surface
from lavendersim.experiment.models import FrictionCone, Impacts, Integrator, Order, Switch
from lavendersim.experiment.quantities import Quantity, Vector3
from lavendersim.experiment.shape_models import Box, Capsule, Cylinder, Plane, Sphere
from lavendersim.experiment.solver_names import Solver
from lavendersim.experiment.study_specs import Mistake

Quaternion = tuple[float, float, float, float]


class _Resolved(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class CellHull(_Resolved):
    """A convex polyhedron in its principal frame."""

    kind: Literal["hull"]
    points: tuple[Vector3, ...]  # [m] corners
    faces: tuple[tuple[int, ...], ...]  # rows of `points`, turning left seen from outside
    centre: Vector3  # [m] the centre of mass in the frame as written
    axes: Quaternion  # principal frame to frame as written


CellSimple = Sphere | Box | Capsule | Cylinder | CellHull


class CellPart(_Resolved):
    """One convex piece of a compound, in the compound's principal frame."""

    shape: CellSimple
    position: Vector3  # [m] of its centre of mass
    orientation: Quaternion  # unit quaternion w x y z, part to compound


class CellCompound(_Resolved):
    """Several shapes that move as one body."""

    kind: Literal["compound"]
    parts: tuple[CellPart, ...]
    centre: Vector3  # [m] the centre of mass in the frame as written
    axes: Quaternion  # principal frame to frame as written


CellShape = Plane | CellSimple | CellCompound


class CellBody(_Resolved):
    """One body, ready to be built."""

    shape: CellShape
    fixed: bool  # neither contacts nor forces move it
    kinematic: bool  # but it keeps its own velocity
    mass: float | None  # [kg]; None for a fixed body
    density: float | None  # [kg/m^3] as written
    inertia: Vector3 | None  # [kg m^2] about the axes of its frame; None for a fixed body
    surface: Surface
    surface_velocity: Vector3  # [m/s] in its frame
    position: Vector3  # [m] centre of mass; of a plane: its point nearest to the origin
    release: Release | None  # as written; `position` follows from it
    orientation: Quaternion  # unit quaternion w x y z, its frame to world
    velocity: Vector3  # [m/s]
    angular_velocity: Vector3  # [rad/s]
    drag: Drag


class CellForce(_Resolved):
    """A force and a torque on one body, constant for a while."""

    body: str
    begin: float = Field(alias="from")  # [s]
    end: float = Field(alias="to")  # [s]
    force: Vector3  # [N] world frame
    torque: Vector3  # [N m] world frame


class CellScene(_Resolved):
    """Gravity, the bodies in the order of the file, then those arranged, and the forces."""

    gravity: Vector3  # [m/s^2]
    bodies: dict[str, CellBody]
    forces: tuple[CellForce, ...]


class CellEvent(_Resolved):
    """One change to a body, applied before the first step that starts at `at` or later."""

    at: float  # [s]
    body: str
    scale_mass: float | None
    teleport: Vector3 | None  # [m]
    velocity: Vector3 | None  # [m/s]
    angular_velocity: Vector3 | None  # [rad/s]
    contact_cache: Literal["keep", "clear"]
    remove: bool  # and nothing else happens to it


class CellTimestep(_Resolved):
    """A timestep that holds from the first step that starts at `at` or later."""

    at: float  # [s]
    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)]  # [s]


class Numerics(_Resolved):
    """Every number of the numerics; see `docs/config.md` for their meaning."""

    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)]  # [s]
    solver: Solver
    sweeps: int
    over_relaxation: float
    order: Order
    tolerance: float | None  # [m/s]
    warm_start: bool
    stabilisation_gain: float
    slop: float  # [m]
    projection: float
    projection_sweeps: int
    restitution_threshold: float  # [g dt]
    cache_distance: float  # [m]
    cache_normal_cosine: float
    speculative: bool
    impacts: Impacts
    integrator: Integrator
    friction_cone: FrictionCone
    sleeping: bool
    sleep_speed: float  # [m/s]
    sleep_time: float  # [s]


class ResidualWindow(_Resolved):
    """A stretch of simulated time [s]."""

    begin: float = Field(alias="from")
    end: float = Field(alias="to")


class CellRecord(_Resolved):
    """What is logged beyond every step."""

    residuals: Literal["none", "all"] | ResidualWindow
    problems: str  # none, or every N


class CellEffects(_Resolved):
    """What the plan is overridden by."""

    force: bool  # what is off is left out even where the scene calls for it
    switches: dict[str, Switch]  # by the name of an effect or a shape pair, sorted


class CellStudy(_Resolved):
    """What is done wrong on purpose."""

    mistake: Mistake


class CellConfig(_Resolved):
    """One cell of an experiment, complete."""

    scene: CellScene
    events: tuple[CellEvent | CellTimestep, ...]
    numerics: Numerics
    duration: float  # [s]
    record: CellRecord
    effects: CellEffects
    study: CellStudy

    @property
    def clock(self) -> Clock:
        """The times of its steps."""
        changes = [one for one in self.events if isinstance(one, CellTimestep)]
        return Clock(self.numerics.timestep, [(written(one.at), one.timestep) for one in changes])

    @property
    def steps(self) -> int:
        """How many steps the duration has, see `Clock.steps_of`."""
        return self.clock.steps_of(written(self.duration))

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON-able data: ratios as `1/480`, vectors as lists."""
        return self.model_dump(mode="json", by_alias=True)
