"""The whole config as written: scene, events, numerics, duration, sweep, record and the claims."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final

from pydantic import ConfigDict, Field

from lavendersim.cell.choices import Preset, Switch
from lavendersim.cell.numerics import Numerics
from lavendersim.experiment.models.always import AlwaysSection
from lavendersim.experiment.models.axis import Axis
from lavendersim.experiment.models.claims import expectation_rules, measure_rules
from lavendersim.experiment.models.cost import CostSpec
from lavendersim.experiment.models.engines import EngineName, Engines
from lavendersim.experiment.models.events import Event
from lavendersim.experiment.models.overhead import OverheadSpec
from lavendersim.experiment.models.record import Record
from lavendersim.experiment.models.recorded import recording_rules
from lavendersim.experiment.models.scene import Scene
from lavendersim.experiment.models.steps import accuracy_rules, step_rules
from lavendersim.experiment.models.study import Study
from lavendersim.experiment.text.place import Place
from lavendersim.figures.specs.catalogue import FigureSpec
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.specs.expectation import ExpectSpec
from lavendersim.peers.catalogue import LAVENDER
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import ConstantName, NewName
from lavendersim.quantities.quantity import Either, Quantity

# Solvers that no sweep visits contact by contact.
_WITHOUT_SWEEPS: Final = ("jacobi", "accelerated_projected_gradient")


class NumericsSource(Numerics):
    """A preset and the values that differ from it; what is not specified comes from the preset."""

    preset: Preset = Field(default="default", description="where the rest is from")


NumericsOf = Annotated[
    Preset | NumericsSource,
    Either("the name of a preset (chapter, default) or a mapping of values", str, dict),
]


class Effects(ConfigModel):
    """Effects and shape pairs by name: `on` forces one in, `off` keeps one out; for study."""

    model_config = ConfigDict(extra="allow")
    # Which names there are is known to the planner.
    __pydantic_extra__: dict[str, Switch] = Field(init=False)

    force: bool = Field(
        default=False, description="leave out what is off even where the scene requires it"
    )

    @property
    def switches(self) -> dict[str, Switch]:
        """What is specified of each name."""
        return self.__pydantic_extra__


Product = dict[NewName, Axis]
SweepOf = Annotated[
    Product | tuple[Product, ...],
    Either("a mapping of axes, or a list of such mappings", dict, tuple),
]


class CellSource(ConfigModel):
    """The part of a config that a sweep can reach and that decides what is simulated."""

    # Sections whose rules and values ask for nothing beside them, and of many values: where they
    # stand as in another cell they are what they were there.
    ALONE: ClassVar[tuple[str, ...]] = ("numerics",)

    constants: dict[ConstantName, Annotated[float, Quantity()]] = Field(
        default={},
        description="name: a number, or a formula of others; `$name` wherever a number is expected",
    )
    scene: Scene = Field(description="gravity, surfaces and bodies")
    events: tuple[Event, ...] = Field(default=(), description="changes during the run")
    numerics: NumericsOf = Field(
        default="default",
        description="how it is simulated: a preset, or values that differ from one",
    )
    duration: Annotated[float, Quantity("s", above=0)] = Field(
        description="[s] simulated time of a run"
    )
    record: Record = Field(
        default=Record(), description="what is logged of which steps, and beyond every step"
    )
    effects: Effects = Field(
        default=Effects(), description="effects forced in or kept out, against the plan; for study"
    )
    study: Study = Field(
        default=Study(), description="a deliberate error; every run with one says so"
    )
    engine: EngineName = Field(
        default=LAVENDER, description="what simulates it: `lavender`, or another that is installed"
    )
    engines: Engines = Field(default=Engines(), description="settings of other engines")

    @classmethod
    def rules(cls, at: Place) -> None:
        """The run has some steps and not too many; sweeps are ordered where there are any."""
        step_rules(at)
        accuracy_rules(at)
        solver = at.get("numerics", "solver")
        for key, idle in (("over_relaxation", "1"), ("order", "coloured")):
            value = at.get("numerics", key)
            if solver.text not in _WITHOUT_SWEEPS or not value:
                continue
            if value.text != idle and value.number != 1:
                sentence = f"{solver.text} treats all contacts at once; expected {idle}"
                at.refuse_pair(solver, value, f"{key}: {sentence}")


class Reduced(ConfigModel):
    """What of a slow experiment is run where time is short: its beginning."""

    duration: Annotated[float, Quantity("s", above=0)] = Field(
        description="[s] simulated time of a reduced run"
    )


class ExperimentConfig(CellSource):
    """One experiment: a question, a scene, what is varied, measured, expected and drawn."""

    extends: str | None = Field(
        default=None,
        description="the file that this one is a change of, such as ../base.yaml",
    )
    question: str = Field(default="", description="what the experiment asks, in words")
    expected: str = Field(default="", description="the expected result and why, in words")
    sweep: SweepOf = Field(
        default={},
        description="axis name: path and values; cells are the product, the first axis slowest; a "
        "list of such mappings is the union of their products, in order",
    )
    measure: dict[NewName, MeasureSpec] = Field(default={}, description="name: what each log gives")
    expect: tuple[ExpectSpec, ...] = Field(default=(), description="the claims that pytest checks")
    always: AlwaysSection | None = Field(
        default=None, description="what every step of every cell must keep; not judged if absent"
    )
    slow: bool = Field(
        default=False,
        description="true: `lavender check` and pytest run it at its reduced length, unless asked "
        "for all of it",
    )
    reduced: Reduced | None = Field(default=None, description="of a slow experiment: what is run")
    figure: FigureSpec | None = Field(default=None, description="what `lavender plot` draws")
    overhead: OverheadSpec | None = Field(
        default=None, description="what each effect costs is measured, after the run"
    )
    cost: CostSpec | None = Field(
        default=None,
        description="what accuracy costs, for `lavender cost`: a grid, an error, a truth",
    )

    @classmethod
    def rules(cls, at: Place) -> None:
        """Expectations have names of their own, what must fail exists, what is taken is logged."""
        super().rules(at)
        if at.written("extends"):  # what is read from a file is merged before it comes here
            at.refuse(at.key("extends"), "extends: a text has no folder to look in; merge it first")
        expectation_rules(at)
        recording_rules(at)
        measure_rules(at)
