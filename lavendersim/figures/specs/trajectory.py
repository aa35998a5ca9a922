"""Where bodies go: one coordinate of their centres against another."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.quantities.names import BodiesName
from lavendersim.quantities.quantity import sentence_error
from lavendersim.quantities.readings import POSES

Coordinate = Literal["x", "y", "z"]


class Trajectory(Panel):
    """One coordinate of centres against another, a line per body and cell; a dot at its start."""

    READS = POSES
    kind: Literal["trajectory"]
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="whose centres, also of arrangements; of all movable bodies when absent",
    )
    x: Coordinate = Field(default="x", description="coordinate on the x axis [m]")
    y: Coordinate = Field(default="z", description="coordinate on the y axis [m]")
    window: tuple[Number, Number] | None = Field(default=None, description="[from, to] shown [s]")
    equal: bool = Field(default=True, description="true: a metre is as long on both axes")

    @model_validator(mode="after")
    def _two_coordinates(self) -> Self:
        if self.x == self.y:
            raise sentence_error("expected two different coordinates as x and y")
        return self
