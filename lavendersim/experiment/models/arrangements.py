"""Arrangements as written: one body in many places, by a few numbers instead of a list."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.experiment.models.bodies import ArrangedBody
from lavendersim.experiment.models.tree import MOST_BODIES
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Position, Quantity, Vector, Vector3

Count = Annotated[int, Quantity(whole=True, minimum=1, maximum=MOST_BODIES)]
Gap = Annotated[float, Quantity("m", minimum=0)]


class Tower(ConfigModel):
    """Bodies one on the other along z, numbered from the lowest."""

    kind: Literal["tower"]
    count: Count = Field(description="number of bodies")
    base: Position = Field(
        default=(0.0, 0.0, 0.0),
        description="[m] x and y of all centres, z of the lowest point of the lowest body",
    )
    gap: Gap = Field(default=0.0, description="[m] between one body and the next above it")
    body: ArrangedBody = Field(description="what stands in each place")


class Pyramid(ConfigModel):
    """Rows along x, each one body shorter than the row below and half a place further in.

    Numbered row by row from the lowest, in x.
    """

    kind: Literal["pyramid"]
    base_count: Annotated[int, Quantity(whole=True, minimum=1, maximum=400)] = Field(
        description="n, bodies of the lowest row; n (n + 1)/2 in all"
    )
    base: Position = Field(
        default=(0.0, 0.0, 0.0),
        description="[m] middle of the lowest row, z of its lowest point",
    )
    gap: Gap = Field(default=0.0, description="[m] between neighbours of a row")
    body: ArrangedBody = Field(description="what stands in each place")


class Grid(ConfigModel):
    """Bodies in columns, rows and layers, numbered along x, then y, then z."""

    kind: Literal["grid"]
    counts: Annotated[
        tuple[int, int, int], Vector(3, Quantity(whole=True, minimum=1, maximum=MOST_BODIES))
    ] = Field(description="number of bodies along x, y, z")
    spacing: Annotated[Vector3, Vector(3, Quantity("m", above=0))] = Field(
        description="[m] from centre to centre along x, y, z"
    )
    origin: Position = Field(
        default=(0.0, 0.0, 0.0), description="[m] centre of mass of the first body"
    )
    jitter: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.0,
        description="[m] every centre is moved by up to so much along each axis, evenly drawn "
        "(Python's Mersenne twister)",
    )
    seed: Annotated[int, Quantity(whole=True, minimum=0, maximum=2**53)] = Field(
        default=0, description="of the jitter: equal seeds give equal scenes"
    )
    body: ArrangedBody = Field(description="what stands in each place")


Arrangement = Annotated[Tower | Pyramid | Grid, Field(discriminator="kind")]
