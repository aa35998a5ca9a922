"""What an effect may know of a scene, and its answer."""

from __future__ import annotations

from typing import NamedTuple


class BodyFacts(NamedTuple):
    """One body as the predicates see it; `spins`: it has an initial angular velocity."""

    name: str
    shape: str
    movable: bool
    spins: bool
    round: bool  # all principal inertias equal


class PairFacts(NamedTuple):
    """Two bodies that may touch, with the properties of their surfaces already mixed."""

    a: str
    b: str
    restitution: float
    compliance: float


class Facts(NamedTuple):
    """A scene and its numerics, reduced to what decides which effects are called for."""

    bodies: tuple[BodyFacts, ...]
    pairs: tuple[PairFacts, ...]
    gravity: tuple[float, float, float]
    stabilisation_gain: float
    projection: float
    warm_start: bool


class Decision(NamedTuple):
    """Whether an effect is on, and the reason in the scene's own words."""

    on: bool
    reason: str


def named(names: list[str]) -> str:
    """List a few names for a sentence: `ball, box_1 and 3 more`."""
    if len(names) <= 3:
        return ", ".join(names)
    return f"{', '.join(names[:2])} and {len(names) - 2} more"
