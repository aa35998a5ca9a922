"""Models of measures of other measures: a ratio, a difference, a power, a number of a row.

measure:
  hard: {kind: impact_impulse, body: ball}
  soft: {kind: impact_impulse, body: pad}
  share: {kind: ratio, measure: soft, to: hard}
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure
from lavendersim.quantities.names import MeasureName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import SUMS

OPERANDS: Final = ("measure", "to", "minus")  # keys that name a measure
Statistic = Literal["max", "min", "mean", "sum", "first", "last"]


class OfMeasures(Measure):
    """A measure of measures that stand above it in the file."""

    READS = SUMS  # those it is of take what they need

    measure: MeasureName = Field(description="the measure it is of; it stands above this one")

    @property
    def operands(self) -> tuple[str, ...]:
        """The measures it is of."""
        return (self.measure,)


class Ratio(OfMeasures):
    """A measure over another; NaN where that is 0. Of rows number by number."""

    NO_NUMBER = "what it divides by is 0, or one of the two is no number"
    kind: Literal["ratio"]
    to: MeasureName = Field(description="the measure it is divided by; it stands above, too")

    @property
    def operands(self) -> tuple[str, ...]:
        """The measures it is of."""
        return (self.measure, self.to)


class DifferenceOf(OfMeasures):
    """A measure less another, in their unit. Of rows number by number."""

    NO_NUMBER = "one of the two is no number"
    kind: Literal["difference"]
    minus: MeasureName = Field(description="the measure that is subtracted; it stands above, too")

    @property
    def operands(self) -> tuple[str, ...]:
        """The measures it is of."""
        return (self.measure, self.minus)


class Power(OfMeasures):
    """A measure to a power, such as 2/3; NaN of 0 to one below 0. Of rows number by number.

    NaN of what is negative, unless the power is whole.
    """

    NO_NUMBER = "what it is of is no number, or has no such power"
    kind: Literal["power"]
    exponent: Annotated[float, Quantity()] = Field(description="the power [-]")


class OfRow(OfMeasures):
    """One number of a row of numbers, in its unit; NaN where the row has a NaN."""

    NO_NUMBER = "a number of the row is none"
    kind: Literal["of_row"]
    of: Statistic = Field(description="which number")
