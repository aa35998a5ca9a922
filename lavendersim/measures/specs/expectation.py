"""The `expect` section of a config: claims about measures, and negative controls.

An expectation names a measure, selects cells with `at`, and carries exactly one judgement. It has
no `kind`: the judgement's own key says it, so the config reads as a sentence:

    - {name: rebound, measure: rebound, at: {e: 0.8}, between: [0.62, 0.68]}

Judged cell by cell: `between`, `at_most`, `at_least`, `exactly`, `equals`, `row`.
Judged across cells: `increasing`, `decreasing`, `ratio`, `order`, `crosses`.
An expectation that selects no cell fails, and so does NaN: a check that cannot fail is none.

A negative control says `fails` instead of a measure and a judgement:

    - {name: a gain above 1 wins energy, fails: energy}

It names an expectation of the file, a check of `always`, or `completes` (a cell that diverges), and
passes when exactly that fails, and nothing else does, in every cell that it selects. One whose name
begins with `known failure` names what lavender does not reach yet, but should.

What `at` selects from: `sweep` is one mapping of axes or a list of such mappings. A list is
the union of the products, in order; an axis absent from a product keeps the config's own value
and is absent from the coordinates of its cells. An axis with a single value is allowed.
Names of expectations are unique within a file (they become test ids).
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field, model_validator

from lavendersim.measures.specs.base import ClosedForm
from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import AxisName, MeasureName
from lavendersim.quantities.quantity import NumberOrFormula, Quantity, sentence_error

# How the name of a `fails` begins that says what lavender does not hold, but should.
KNOWN_FAILURE: Final = "known failure"
Number = Annotated[float, Quantity()]
Expected = Annotated[float | str, NumberOrFormula()]
Tolerance = Annotated[float, Quantity(minimum=0)]
Aggregate = Literal["max", "min", "mean"]

CELL_JUDGEMENTS = ("between", "at_most", "at_least", "exactly", "equals", "row")
SWEEP_JUDGEMENTS = ("increasing", "decreasing", "ratio", "order", "crosses")


NO_TOLERANCE: Final = "expected relative or absolute above 0; use `exactly` for no tolerance"


class Equals(ConfigModel):
    """Agreement with a number or a closed form, within a relative and/or an absolute tolerance."""

    value: Expected | None = Field(
        default=None,
        description="the number, in the measure's unit, or a formula of constants and axes: "
        "`5/7 * $g * sin($slope)`",
    )
    closed_form: ClosedForm | None = Field(default=None, description="or the formula that gives it")
    relative: Tolerance = Field(default=0.0, description="allowed |difference / expected| [-]")
    absolute: Tolerance = Field(default=0.0, description="allowed |difference|, measure's unit")

    @model_validator(mode="after")
    def _one_reference(self) -> Equals:
        if (self.value is None) == (self.closed_form is None):
            raise sentence_error("expected exactly one of value, closed_form")
        if self.relative == 0.0 and self.absolute == 0.0:
            raise sentence_error(NO_TOLERANCE)
        return self


EqualsOf = Equals | Expected


class Trend(ConfigModel):
    """Strict order along one axis, in every group of cells that differ in this axis alone."""

    along: AxisName = Field(description="the axis whose values are put in rising order")


class Ratio(ConfigModel):
    """The measure reduced over the cells `of`, divided by the same over the cells `to`."""

    of: Selection = Field(description="cells of the numerator, among those of `at`")
    to: Selection = Field(description="cells of the denominator, among those of `at`")
    each: tuple[AxisName, ...] = Field(
        default=(), description="judge once for every combination of values of these axes"
    )
    reduce: Aggregate = Field(default="max", description="how several cells become one number")
    at_most: Number | None = Field(default=None, description="largest ratio allowed [-]")
    at_least: Number | None = Field(default=None, description="smallest ratio allowed [-]")
    floor: Tolerance = Field(
        default=0.0,
        description="rows are compared number by number until numerator and denominator both are "
        "at or below this round-off level [measure's unit]",
    )
    negligible: Tolerance = Field(
        default=0.0,
        description="a numerator at or below this passes, whatever it is divided by [measure's "
        "unit]",
    )

    @model_validator(mode="after")
    def _bounded(self) -> Ratio:
        if self.at_most is None and self.at_least is None:
            raise sentence_error("expected at_most or at_least")
        return self


class Order(ConfigModel):
    """The p of measure ~ axis^p: the slope of a line through their logarithms (least squares)."""

    along: AxisName = Field(description="the axis, such as the timestep; its values are above 0")
    reduce: Aggregate = Field(default="max", description="how the other axes become one number")
    at_least: Number = Field(description="smallest order allowed [-]")
    at_most: Number | None = Field(default=None, description="largest order allowed [-]")
    negligible: Tolerance = Field(
        default=0.0,
        description="passes where every number is at or below this, round-off has no order "
        "[measure's unit]",
    )


class Crosses(ConfigModel):
    """Where along an axis the reduced measure first rises through a level, interpolated."""

    along: AxisName = Field(description="the axis, in whose unit the place is given")
    level: Number = Field(description="the level, in the measure's unit")
    reduce: Aggregate = Field(default="mean", description="how the other axes become one number")
    between: tuple[Number, Number] = Field(description="bounds of the place, in the axis's unit")


class ExpectSpec(ConfigModel):
    """One claim about a measure with exactly one judgement, or what must fail."""

    name: str = Field(min_length=1, description="what is claimed, in words; the name of the test")
    measure: MeasureName = Field(default="", description="the measure the claim is about")
    fails: str | None = Field(
        default=None,
        description="instead of a measure: the expectation, check of `always` or `completes` that "
        "must fail, and nothing else",
    )
    at: Selection = Field(
        default_factory=dict,
        description="the cells it is about; all that have the measure, if absent",
    )
    between: tuple[Number, Number] | None = Field(
        default=None, description="closed bounds [low, high], in the measure's unit"
    )
    at_most: Number | None = Field(default=None, description="upper bound, measure's unit")
    at_least: Number | None = Field(default=None, description="lower bound, measure's unit")
    exactly: Number | None = Field(default=None, description="this number, bit for bit")
    equals: EqualsOf | None = Field(
        default=None,
        description="a number or a formula, with `relative` or `absolute` beside it; or a mapping",
    )
    relative: Tolerance = Field(
        default=0.0, description="of an `equals` that is no mapping: |difference / expected| [-]"
    )
    absolute: Tolerance = Field(
        default=0.0, description="of an `equals` that is no mapping: |difference|, measure's unit"
    )
    row: Literal["increasing", "decreasing"] | None = Field(
        default=None, description="the numbers of a measure that gives a row strictly rise or fall"
    )
    increasing: Trend | None = Field(default=None, description="strictly rises along an axis")
    decreasing: Trend | None = Field(default=None, description="strictly falls along an axis")
    ratio: Ratio | None = Field(default=None, description="ratio between two selections of cells")
    order: Order | None = Field(default=None, description="the power of an axis it goes with")
    crosses: Crosses | None = Field(default=None, description="where it rises through a level")

    @model_validator(mode="after")
    def _one_judgement(self) -> ExpectSpec:
        given = [
            key for key in (*CELL_JUDGEMENTS, *SWEEP_JUDGEMENTS) if getattr(self, key) is not None
        ]
        if self.fails is not None:
            if given or self.measure:
                besides = ", ".join([*(["measure"] if self.measure else []), *given])
                raise sentence_error(
                    f"expected nothing beside fails but name and at; found {besides}"
                )
            return self
        if not self.measure:
            raise sentence_error('missing key "measure": the measure the claim is about')
        if len(given) != 1:
            kinds = ", ".join((*CELL_JUDGEMENTS, *SWEEP_JUDGEMENTS))
            found = ", ".join(given) if given else "none"
            raise sentence_error(f"expected exactly one judgement of {kinds}; found {found}")
        self._check_tolerance()
        for bounds in (self.between, self.crosses and self.crosses.between):
            if bounds and bounds[0] > bounds[1]:
                raise sentence_error("expected the lower bound first in `between`")
        return self

    def _check_tolerance(self) -> None:
        given = self.relative > 0.0 or self.absolute > 0.0
        if isinstance(self.equals, float | str):
            if not given:
                raise sentence_error(NO_TOLERANCE)
        elif given:
            where = "inside it" if self.equals is not None else "beside `equals`"
            raise sentence_error(f"relative and absolute stand {where}")

    @property
    def agreement(self) -> Equals | None:
        """What `equals` says, in either of its forms."""
        if isinstance(self.equals, float | str):
            return Equals(value=self.equals, relative=self.relative, absolute=self.absolute)
        return self.equals

    @property
    def known_failure(self) -> bool:
        """Whether its name says that lavender does not reach this yet, but should."""
        return self.fails is not None and self.name.startswith(KNOWN_FAILURE)

    @property
    def judgement(self) -> str:
        """The key of the one judgement given."""
        keys = (*CELL_JUDGEMENTS, *SWEEP_JUDGEMENTS)
        return next(key for key in keys if getattr(self, key) is not None)

    @property
    def per_cell(self) -> bool:
        """True when each selected cell is judged alone (one test per cell)."""
        return self.judgement in CELL_JUDGEMENTS
