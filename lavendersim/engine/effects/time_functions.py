"""Functions of time, as a config has them: a ramp, a sine, a pulse, a table linear between entries.

All are one form, which kernels evaluate and integrate exactly (`drives`):
    f(t) = g(t) + a sin(omega t + phi)
g is linear between knots, may jump where two knots have one time, has the value of the first knot
before it, and goes on from the last one with a slope. Values have no unit: they are factors.
"""

from __future__ import annotations

from math import pi, radians
from typing import Annotated, Any, Final, Literal, NamedTuple

from pydantic import Field

from lavendersim.quantities.chosen_kind import ByKind
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity

MOST_ENTRIES = 10_000  # of a table

_Time = Annotated[float, Quantity("s", minimum=0)]


class Terms(NamedTuple):
    """A function of time, in the form above."""

    knots: tuple[tuple[float, float], ...]  # time [s], value [-]; times ascend, at least one
    slope: float = 0.0  # behind the last knot [1/s]
    amplitude: float = 0.0  # a [-]
    omega: float = 0.0  # [rad/s]
    phase: float = 0.0  # phi [rad]

    @property
    def jumps(self) -> bool:
        """Whether its value jumps."""
        pairs = zip(self.knots, self.knots[1:], strict=False)
        return any(a[0] == b[0] and a[1] != b[1] for a, b in pairs)

    @property
    def steepest(self) -> float:
        """No slope between jumps is steeper [1/s]."""
        pairs = zip(self.knots, self.knots[1:], strict=False)
        slopes = [abs((b[1] - a[1]) / (b[0] - a[0])) for a, b in pairs if b[0] > a[0]]
        return max([abs(self.slope), *slopes]) + abs(self.amplitude * self.omega)


CONSTANT: Final = Terms(((0.0, 1.0),))


class Ramp(ConfigModel):
    """0 up to `from`, then growing by `rate`, and constant behind `to`."""

    kind: Literal["ramp"]
    rate: Annotated[float, Quantity("1/s")] = Field(default=1.0, description="[1/s] growth")
    begin: _Time = Field(default=0.0, alias="from", description="[s] where it begins to grow")
    end: _Time | None = Field(
        default=None, alias="to", description="[s] from where it stays; none: it grows for ever"
    )

    @classmethod
    def rules(cls, at: Any) -> None:
        """It ends after it begins."""
        _ends_after_it_begins(at)

    def terms(self) -> Terms:
        """Return its form."""
        if self.end is None:
            return Terms(((self.begin, 0.0),), self.rate)
        return Terms(((self.begin, 0.0), (self.end, self.rate * (self.end - self.begin))))


class Sine(ConfigModel):
    """offset + amplitude sin(2 pi frequency t + phase)."""

    kind: Literal["sine"]
    frequency: Annotated[float, Quantity("Hz", above=0)] = Field(description="[Hz]")
    amplitude: Annotated[float, Quantity()] = Field(default=1.0, description="[-]")
    phase_degrees: Annotated[float, Quantity("degree")] = Field(
        default=0.0, description="[degree] at time 0; 90 makes it a cosine"
    )
    offset: Annotated[float, Quantity()] = Field(default=0.0, description="[-] its mean")

    def terms(self) -> Terms:
        """Return its form."""
        return Terms(
            ((0.0, self.offset),),
            amplitude=self.amplitude,
            omega=2.0 * pi * self.frequency,
            phase=radians(self.phase_degrees),
        )


class Pulse(ConfigModel):
    """1 from `from` up to `to`, 0 before and after, to the instant: within a step its share."""

    kind: Literal["pulse"]
    begin: _Time = Field(alias="from", description="[s] begin")
    end: _Time = Field(alias="to", description="[s] end")

    @classmethod
    def rules(cls, at: Any) -> None:
        """It ends after it begins."""
        _ends_after_it_begins(at)

    def terms(self) -> Terms:
        """Return its form."""
        begin, end = self.begin, self.end
        return Terms(((begin, 0.0), (begin, 1.0), (end, 1.0), (end, 0.0)))


class FactorTable(ConfigModel):
    """Linear between its entries; the first value before them, the last one behind them."""

    kind: Literal["table"]
    # Not strict: a log's config has lists.
    times: tuple[_Time, ...] = Field(
        strict=False,
        min_length=2,
        max_length=MOST_ENTRIES,
        description="[s] each later than the one before",
    )
    values: tuple[Annotated[float, Quantity()], ...] = Field(
        strict=False, min_length=2, max_length=MOST_ENTRIES, description="[-] one for each time"
    )

    @classmethod
    def rules(cls, at: Any) -> None:
        """Times ascend, and each has its value."""
        times, values = at.get("times"), at.get("values")
        for before, after in zip(times.items, times.items[1:], strict=False):
            one, other = before.number, after.number
            if one is not None and other is not None and other <= one:
                at.refuse(after.mark, f"times: expected a time after {one:g} s, found {other:g}")
                return
        if times.items and values.items and len(times.items) != len(values.items):
            counts = f"{len(times.items)} times and {len(values.items)} values"
            at.refuse(values.mark, f"values: expected one for each time, found {counts}")

    def terms(self) -> Terms:
        """Return its form."""
        return Terms(tuple(zip(self.times, self.values, strict=True)))


TimeFunction = Annotated[Ramp | Sine | Pulse | FactorTable, ByKind()]


def terms_of(function: TimeFunction | None) -> Terms:
    """Return the form of a function; None is 1 at all times."""
    return CONSTANT if function is None else function.terms()


def _ends_after_it_begins(at: Any) -> None:
    begin, end = at.get("from"), at.get("to")
    start = begin.number if begin else 0.0
    if start is not None and end.number is not None and end.number <= start:
        at.refuse(end.mark, f"to: expected a time after from ({start:g} s), found {end.number:g}")
