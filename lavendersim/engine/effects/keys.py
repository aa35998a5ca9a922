"""Config keys that effects declare: type with its quantity, default, meaning; and how pairs mix.

`cell` and `experiment` compose their models of surfaces and scenes of them, so a key is accepted,
checked and described like any other of the config.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Annotated, Any, Final

from lavendersim.quantities.quantity import Quantity, Vector3

# A vector of a body's frame as written, in the frame of its principal axes.
Turn = Callable[[Vector3], Vector3]
TurnOf = Callable[[str, Vector3], Vector3]  # the same, by the name of the body


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a section of a config."""

    name: str
    type: Any  # annotated with its quantity
    default: Any
    doc: str  # one line: unit and meaning


@dataclass(frozen=True, kw_only=True)
class SurfaceKey(Key):
    """A property of surfaces; a contact has one value of it, mixed of those of its two surfaces.

    The last clause of `doc` says how, behind a semicolon.
    """

    mix: Callable[[float, float], float]
    needs: str = ""  # another of the same surface, which is above 0 where this one is

    @property
    def meaning(self) -> str:
        """Unit and meaning of one value, however it came about."""
        return self.doc.rpartition("; ")[0] or self.doc


@dataclass(frozen=True, kw_only=True)
class SceneKey(Key):
    """A key of the scene; its value is the same as written and resolved, but for frames."""

    resolve: Callable[[Any, TurnOf], Any]


def as_written(value: Any, turn: Turn) -> Any:
    """Return what has no direction."""
    return value


@dataclass(frozen=True, kw_only=True)
class BodyKey(Key):
    """A key of bodies; its value is the same as written and resolved, but for the frame."""

    resolve: Callable[[Any, Turn], Any] = as_written
    of_movable: bool = False  # a body that does not move has none
    of_prescribed: bool = False  # only a body whose motion is prescribed has one, and no velocities
    by_event: bool = False  # an event may change it during the run
    prescribes_motion: bool = False  # a body where it is true moves whatever touches it, massless


def larger(one: float, other: float) -> float:
    """Return the larger of two surfaces' values."""
    return max(one, other)


def smaller_above_zero(one: float, other: float) -> float:
    """Return the smaller of two surfaces' values that are above 0; 0 where none is."""
    return min(one, other) if min(one, other) > 0.0 else max(one, other)


def mean_above_zero(one: float, other: float) -> float:
    """Return the geometric mean of two surfaces' values; of one that is 0 that of the other."""
    return sqrt(one * other) if min(one, other) > 0.0 else max(one, other)


def in_series(one: float, other: float) -> float:
    """Return the sum, as the compliances of two springs in series add."""
    return one + other


def geometric_mean(one: float, other: float) -> float:
    """Return sqrt(one * other): 0 where one of the two is."""
    return sqrt(one * other)


SHARE: Final = Annotated[float, Quantity(minimum=0, maximum=1)]
COEFFICIENT: Final = Annotated[float, Quantity(minimum=0)]
LENGTH: Final = Annotated[float, Quantity("m", minimum=0)]
COMPLIANCE: Final = Annotated[float, Quantity("m/N", minimum=0)]
FORCE: Final = Annotated[float, Quantity("N", minimum=0)]
SPEED: Final = Annotated[float, Quantity("m/s", minimum=0)]
