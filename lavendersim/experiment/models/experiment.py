"""The whole config as written: scene, events, numerics, duration, sweep, record and the claims."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, Tag

from lavendersim.cell.choices import FrictionCone, Impacts, Integrator, Order, Solver, Switch
from lavendersim.experiment.models.always import Always
from lavendersim.experiment.models.cost import CostSpec
from lavendersim.experiment.models.expect import ExpectSpec
from lavendersim.experiment.models.figure import FigureSpec
from lavendersim.experiment.models.measures import MeasureSpec
from lavendersim.experiment.models.overhead import PriceSpec
from lavendersim.experiment.models.record import Record
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.models.study import Study
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName, NewName
from lavendersim.quantities.quantity import (
    AngularVelocity,
    Position,
    Quantity,
    Velocity,
    either,
)


class Event(ConfigModel):
    """A change to one body, or of the timestep, before the first step that starts at `at`."""

    at: Annotated[float, Quantity("s", minimum=0)] = Field(description="[s] simulated time")
    body: BodyName | None = Field(
        default=None, description="name of a body; required but for a timestep"
    )
    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)] | None = Field(
        default=None, description="[s] length of the steps from then on; stands without a body"
    )
    scale_mass: Annotated[float, Quantity(above=0)] | None = Field(
        default=None, description="factor on mass and inertia"
    )
    teleport: Position | None = Field(
        default=None, description="[m] new centre of mass; clears the body's cached contacts"
    )
    velocity: Velocity | None = Field(
        default=None, description="[m/s] new velocity of the centre of mass"
    )
    angular_velocity: AngularVelocity | None = Field(
        default=None, description="[rad/s] new angular velocity, world frame"
    )
    contact_cache: Literal["keep", "clear"] | None = Field(
        default=None,
        description="clear: every cached impulse is dropped, the next solve starts cold; "
        "not stated: keep",
    )
    remove: bool | None = Field(
        default=None, description="true: the body, which may be fixed, takes part in nothing more"
    )


Count = Annotated[int, Quantity(whole=True, minimum=1, maximum=1_000_000)]
CountOrNone = Annotated[int, Quantity(whole=True, minimum=0, maximum=1_000_000)]


class NumericsChange(ConfigModel):
    """A preset and the values that differ from it; what is not stated comes from the preset."""

    preset: Literal["chapter", "default"] = Field(
        default="default", description="where the rest is from"
    )
    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)] | None = Field(
        default=None, description="[s] a ratio such as 1/480 is kept exactly"
    )
    solver: Solver | None = Field(default=None, description="the solver of the contact problem")
    sweeps: Count | None = Field(default=None, description="most velocity sweeps per step")
    over_relaxation: Annotated[float, Quantity(above=0, below=2)] | None = Field(
        default=None, description="factor on the changes that velocity sweeps make; 1: none"
    )
    order: Order | None = Field(default=None, description="in which sweeps visit contacts")
    tolerance: Annotated[float, Quantity("m/s", above=0)] | None = Field(
        default=None, description="[m/s] residual at which sweeping stops early; null: never"
    )
    warm_start: bool | None = Field(
        default=None, description="start a solve from the cached impulses"
    )
    stabilisation_gain: Annotated[float, Quantity(minimum=0)] | None = Field(
        default=None,
        description="beta: share of (penetration - slop) per step that becomes bias velocity",
    )
    slop: Annotated[float, Quantity("m", minimum=0)] | None = Field(
        default=None, description="[m] penetration that is left alone"
    )
    projection: Annotated[float, Quantity(minimum=0, maximum=1)] | None = Field(
        default=None, description="share of (penetration - slop) moved out per step; 0: off"
    )
    projection_sweeps: CountOrNone | None = Field(
        default=None, description="sweeps of the positional projection per step"
    )
    restitution_threshold: Annotated[float, Quantity("g dt", minimum=0)] | None = Field(
        default=None, description="[g dt] approach speed above which restitution acts"
    )
    cache_distance: Annotated[float, Quantity("m", minimum=0)] | None = Field(
        default=None, description="[m] largest distance between a contact and its cached match"
    )
    cache_normal_cosine: Annotated[float, Quantity(minimum=-1, maximum=1)] | None = Field(
        default=None,
        description="smallest cosine between a contact's normal and its cached match's",
    )
    speculative: bool | None = Field(
        default=None, description="contacts are made ahead of touching; a gap may close, no more"
    )
    impacts: Impacts | None = Field(
        default=None,
        description="when restitution acts: captured (at the start of the step that finds the "
        "contact) or at_surface (at the time within the step when the surfaces meet)",
    )
    integrator: Integrator | None = Field(
        default=None, description="how poses follow from velocities between contacts"
    )
    friction_cone: FrictionCone | None = Field(
        default=None,
        description="disc: Coulomb's law; for study pyramid: each tangent on its own; convex: the "
        "relaxation that lifts what slides",
    )
    sleeping: bool | None = Field(
        default=None, description="bodies that have come to rest are left out until touched"
    )
    sleep_speed: Annotated[float, Quantity("m/s", minimum=0)] | None = Field(
        default=None, description="[m/s] speed of every point below which a body counts as at rest"
    )
    sleep_time: Annotated[float, Quantity("s", minimum=0)] | None = Field(
        default=None, description="[s] how long a body is at rest before it sleeps"
    )


def _numerics_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "preset", dict: "values"}
    return forms.get(type(value))


NumericsOf = Annotated[
    Annotated[Literal["chapter", "default"], Tag("preset")]
    | Annotated[NumericsChange, Tag("values")],
    either("the name of a preset (chapter, default) or a mapping of values", _numerics_form),
]


class Effects(ConfigModel):
    """Effects and shape pairs by name: `on` forces one in, `off` keeps one out; for study."""

    model_config = ConfigDict(extra="allow")
    # Which names there are is known to the planner.
    __pydantic_extra__: dict[str, Switch] = Field(init=False)

    force: bool = Field(
        default=False, description="leave out what is off even where the scene calls for it"
    )

    @property
    def switches(self) -> dict[str, Switch]:
        """What is stated of each name."""
        return self.__pydantic_extra__


class Axis(ConfigModel):
    """One quantity that is varied: the path of a value in this file and the values it takes."""

    path: str = Field(description="such as scene.bodies.ball.mass or numerics.timestep")
    values: tuple[Any, ...] = Field(
        min_length=1, description="one cell per value; ratios are kept exactly"
    )


def _sweep_form(value: Any) -> str | None:
    forms: dict[type, str] = {dict: "product", tuple: "union", list: "union"}
    return forms.get(type(value))


Product = dict[NewName, Axis]
SweepOf = Annotated[
    Annotated[Product, Tag("product")] | Annotated[tuple[Product, ...], Tag("union")],
    either("a mapping of axes, or a list of such mappings", _sweep_form),
]


class CellSource(ConfigModel):
    """The part of a config that a sweep can reach and that decides what is simulated."""

    scene: Scene = Field(description="gravity, surfaces and bodies")
    events: tuple[Event, ...] = Field(default=(), description="changes during the run")
    numerics: NumericsOf = Field(
        default="default", description="name of a preset, or a mapping of values that may name one"
    )
    duration: Annotated[float, Quantity("s", above=0)] = Field(
        description="[s] simulated time of a run"
    )
    record: Record = Field(default=Record(), description="what is logged beyond every step")
    effects: Effects = Field(
        default=Effects(), description="effect or shape pair: on or off, against the plan"
    )
    study: Study = Field(
        default=Study(), description="a known mistake, made on purpose; every run with one says so"
    )


class Reduced(ConfigModel):
    """What of a slow experiment is run where time is short: its beginning."""

    duration: Annotated[float, Quantity("s", above=0)] = Field(
        description="[s] simulated time of a reduced run"
    )


class ExperimentConfig(CellSource):
    """One experiment: a question, a scene, what is varied, measured, expected and drawn."""

    question: str = Field(default="", description="what the experiment asks, in words")
    expected: str = Field(default="", description="the expected result and why, in words")
    sweep: SweepOf = Field(
        default={},
        description="axis name: path and values; cells are the product, the first axis slowest; "
        "a list of such mappings is the union of their products, in order",
    )
    measure: dict[NewName, MeasureSpec] = Field(default={}, description="name: what each log gives")
    expect: tuple[ExpectSpec, ...] = Field(default=(), description="the claims that pytest checks")
    always: Always | None = Field(
        default=None, description="what every step of every cell must keep; not judged if absent"
    )
    slow: bool = Field(
        default=False,
        description="true: `lavender check` and pytest run it at its reduced length, unless asked "
        "for all of it",
    )
    reduced: Reduced | None = Field(default=None, description="of a slow experiment: what is run")
    figure: FigureSpec | None = Field(default=None, description="what `lavender plot` draws")
    price: PriceSpec | None = Field(default=None, description="what each effect costs is taken")
    cost: CostSpec | None = Field(
        default=None,
        description="what accuracy costs, for `lavender cost`: a grid, an error, a truth",
    )
