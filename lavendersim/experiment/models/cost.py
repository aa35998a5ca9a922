"""The section `cost`: a grid of settings, an error, and the truth it is taken from.

The grid is timestep x solver x (sweeps or tolerance) x warm start; beside it stand accuracies that
are asked for in place of a timestep. Its error is one measure of the experiment, compared with what
is true.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.cell.choices import Preset, Solver
from lavendersim.cell.numerics import Accuracy, Sweeps, Timestep, Tolerance
from lavendersim.experiment.models.overhead import TimedFrom, refuse_what_interrupts
from lavendersim.experiment.models.tree import products
from lavendersim.experiment.text.node import key_mark
from lavendersim.experiment.text.place import Place
from lavendersim.measures.specs.base import ClosedForm
from lavendersim.peers.catalogue import PEERS
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import MeasureName
from lavendersim.quantities.quantity import Either, Quantity

# The numerics that a setting of the grid has, beside an accuracy.
KNOBS: Final = ("timestep", "solver", "sweeps", "tolerance", "warm_start")
# Names of the grid's own axes; those of another engine begin with its name.
GRID_NAMES: Final = frozenset(("numerics", "preset", *KNOBS, "accuracy", "engine"))
FEWEST_REPEATS = 7  # of six samples the interval that holds the median is all of them
FEW = "of fewer, one slow moment of the machine decides where the median lies"

Share = Annotated[float, Quantity(above=0)]
Repeats = Annotated[int, Quantity(whole=True, minimum=FEWEST_REPEATS, maximum=1000, hint=FEW)]


Truth = Annotated[
    Annotated[float, Quantity()] | Literal["finest"] | ClosedForm,
    Either("a number, {form, bodies}, or finest", float, "finest", dict),
]
SolverNames = Annotated[
    Literal["all"] | Annotated[tuple[Solver, ...], Field(min_length=1)],
    Either("all, or a list of solvers", "all", tuple),
]


class CostError(ConfigModel):
    """What is wrong in a run: |measure - truth| / scale, the worst over cells and rows."""

    measure: MeasureName = Field(
        description="the measure that is compared with the truth; of a row of numbers the worst "
        "counts"
    )
    truth: Truth = Field(
        default=0.0,
        description="a number, a closed form `{form, bodies}`, or `finest`: the measure at an "
        "eighth of the grid's finest timestep, solved to 1e-12 m/s",
    )
    scale: Annotated[float, Quantity(above=0)] | None = Field(
        default=None,
        description="[measure's unit] what an error of 100 % is; none: |truth|, or 1 for a truth "
        "of 0",
    )


class CostSpec(ConfigModel):
    """What accuracy costs in this scene: taken by `lavender cost`."""

    error: CostError = Field(description="what is wrong in a run, as a fraction")
    presets: Annotated[tuple[Preset, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="presets whose other numerics (the laws) are compared; none: the config's "
        "alone",
    )
    timesteps: Annotated[tuple[Timestep, ...], Field(min_length=1)] = Field(
        default=(Fraction(1, 60), Fraction(1, 120), Fraction(1, 240), Fraction(1, 480)),
        description="[s] timesteps of the grid",
    )
    solvers: SolverNames = Field(default="all", description="all, or names of solvers")
    sweeps: Annotated[tuple[Sweeps, ...], Field(min_length=1)] = Field(
        default=(2, 4, 8, 16, 32, 64),
        description="of solvers that take all sweeps they are given; their tolerance is null",
    )
    tolerances: Annotated[tuple[Tolerance, ...], Field(min_length=1)] = Field(
        default=(1e-3, 1e-6, 1e-9),
        description="[m/s] of `adaptive`, which sweeps until it is there",
    )
    warm_start: Annotated[tuple[bool, ...], Field(min_length=1)] = Field(
        default=(True, False), description="true, false or both"
    )
    accuracies: tuple[Accuracy, ...] = Field(
        default=(1e-2, 1e-3, 1e-4, 1e-5),
        description="asked for of `adaptive` at the longest of the timesteps and the least of the "
        "tolerances, where the laws are of order 2; []: none",
    )
    not_converged: Annotated[float, Quantity(minimum=0, maximum=1)] = Field(
        default=0.01,
        description="share of steps that may end above the tolerance before a setting has failed",
    )
    targets: Annotated[tuple[Share, ...], Field(min_length=1)] = Field(
        default=(0.01, 0.001), description="errors whose cheapest setting is reported; 0.01 is 1 %"
    )
    repeats: Repeats = Field(
        default=9, description="rounds, 7 or more; every round times every setting"
    )
    begin: TimedFrom = 0.0

    @classmethod
    def rules(cls, at: Place) -> None:
        """The scene is timed in one go, and its sweep leaves alone what the grid varies."""
        refuse_what_interrupts(at, "a scene")
        for product in products(at.root):
            for name, axis in product.entries.items():
                path = axis.get("path")
                varied = (path.text or "").split(".")[0]
                if varied == "engine" and path.mark.file.startswith("--"):
                    continue  # of `lavender run --engine`, to which the section is nothing
                if varied == "numerics":
                    sentence = "numerics are varied by the section cost; leave them to that"
                    at.refuse(path.mark, f"path: {sentence}")
                elif varied in ("engine", "engines"):
                    sentence = "engines are chosen by `lavender cost --engine`; leave them to that"
                    at.refuse(path.mark, f"path: {sentence}")
                elif name in GRID_NAMES or name.partition("_")[0] in PEERS:
                    sentence = "the section cost has an axis of this name; rename this one"
                    at.refuse(key_mark(product, name), f"{name}: {sentence}")
