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

Turn = Callable[[str, Vector3], Vector3]  # of a body: a vector of its frame as written, resolved


@dataclass(frozen=True, kw_only=True)
class Key:
    """One key of a section of a config."""

    name: str
    type: Any  # annotated with its quantity
    default: Any
    doc: str  # one line: unit and meaning


@dataclass(frozen=True, kw_only=True)
class SurfaceKey(Key):
    """A property of surfaces; a contact has one value of it, mixed of those of its two surfaces."""

    mix: Callable[[float, float], float]


@dataclass(frozen=True, kw_only=True)
class SceneKey(Key):
    """A key of the scene; its value is the same as written and resolved, but for frames."""

    resolve: Callable[[Any, Turn], Any]


def larger(one: float, other: float) -> float:
    """Return the larger of two surfaces' values."""
    return max(one, other)


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
