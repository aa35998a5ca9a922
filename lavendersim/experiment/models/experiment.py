"""The whole config as written: scene, events, numerics, duration, sweep, record and the claims."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, Tag

from lavendersim.cell.choices import Preset, Switch
from lavendersim.cell.numerics import Numerics
from lavendersim.experiment.models.cost import CostSpec
from lavendersim.experiment.models.overhead import PriceSpec
from lavendersim.experiment.models.record import Record
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.models.study import Study
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.measures.specs.always import Always
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.specs.expectation import ExpectSpec
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


class NumericsSource(Numerics):
    """A preset and the values that differ from it; what is not specified comes from the preset."""

    preset: Preset = Field(default="default", description="where the rest is from")


def _numerics_form(value: Any) -> str | None:
    forms: dict[type, str] = {str: "preset", dict: "values"}
    return forms.get(type(value))


NumericsOf = Annotated[
    Annotated[Preset, Tag("preset")] | Annotated[NumericsSource, Tag("values")],
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
