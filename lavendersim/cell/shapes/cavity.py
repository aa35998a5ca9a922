"""Cavities: all around a ball or an endless cylinder of radius R is solid; bodies are inside.

A convex body touches with its point that is farthest from the centre, or from the axis. A cavity
has no mass; it stands still, or its motion is prescribed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from lavendersim.cell.shapes.shape import Length
from lavendersim.quantities.model import ConfigModel


class Cavity(ConfigModel):
    """What bowls and drums have in common."""

    # Shapes of which a file of `engine/collide/pairs` says where they touch it.
    HOLDS: ClassVar[frozenset[str]] = frozenset(
        {"sphere", "box", "capsule", "cylinder", "ellipsoid", "cone", "hull"}
    )
    if TYPE_CHECKING:
        kind: str

    radius: Length = Field(description="[m] from the centre or the axis to the surface")


class Bowl(Cavity):
    """The inside of a sphere: all that is farther from its centre than the radius is solid."""

    kind: Literal["bowl"]


class Drum(Cavity):
    """The inside of a cylinder without ends: all that is farther from the body's z is solid."""

    kind: Literal["drum"]
