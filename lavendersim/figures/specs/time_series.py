"""A logged quantity against time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from lavendersim.figures.specs.base import Number, Panel
from lavendersim.figures.specs.ideal import Ideal
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity, sentence_error
from lavendersim.quantities.readings import CONTACTS, POSES, SUMS, VELOCITIES, Readings

Column = Literal[
    "penetration",
    "normal_force",
    "clearance",
    "energy",
    "residual",
    "signorini",
    "cone",
    "dissipation",
    "drift",
    "overlap",
    "position_x",
    "position_y",
    "position_z",
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "angular_velocity_x",
    "angular_velocity_y",
    "angular_velocity_z",
    "kinetic_energy",
    "potential_energy",
]
POSITIONS: Final = ("position_x", "position_y", "position_z")
SPEEDS: Final = (
    *("velocity_x", "velocity_y", "velocity_z"),
    *("angular_velocity_x", "angular_velocity_y", "angular_velocity_z"),
)
OF_STEPS: Final = ("kinetic_energy", "potential_energy")


OF_COLUMNS: Final = {
    "penetration": CONTACTS,
    "normal_force": CONTACTS,
    "clearance": POSES,
    "drift": POSES,
    "overlap": POSES,
    **dict.fromkeys(POSITIONS, POSES),
    **dict.fromkeys(SPEEDS, VELOCITIES),
}


class TimeSeries(Panel):
    """A logged quantity against time, one line with markers per cell."""

    @classmethod
    def reads(cls, given: Mapping[str, str | None]) -> Readings:
        """What its column is taken from, and contacts where time is counted from the first."""
        counted = CONTACTS if given.get("start") == "first_contact" else SUMS
        return counted | OF_COLUMNS.get(given.get("column") or "", SUMS)

    kind: Literal["time_series"]
    column: Column = Field(
        description="penetration [m], normal_force [N], clearance [m], energy [J], residual [m/s], "
        "drift [m] of any centre from its place at 0.5 s, overlap [m] of any two bodies, from "
        "poses, signorini [m/s], cone [N s], dissipation [J]: the worst contact's violation; "
        "position_x, position_y, position_z [m] of a body's centre, velocity_x and so on [m/s], "
        "angular_velocity_x and so on [rad/s], with `record: {velocities: true}`; kinetic_energy, "
        "potential_energy [J] of the scene"
    )
    body: BodyName | None = Field(
        default=None,
        description="the body, for penetration, normal_force; of clearance, positions, velocities",
    )
    above: PlaneName | None = Field(default=None, description="the plane, for clearance")
    start: Literal["run", "first_contact"] = Field(
        default="run", description="what time zero means on the x axis"
    )
    window: tuple[Number, Number] | None = Field(
        default=None, description="[from, to] around that zero [s]"
    )
    every: Annotated[int, Quantity(whole=True, minimum=1)] = Field(
        default=1, description="for overlap: every k-th logged step, counted back from the last [-]"
    )
    ideal: Ideal | None = Field(default=None, description="the constant it approaches")
    factor: Number = Field(default=1.0, description="multiplies the values for display")
    x_factor: Number = Field(default=1.0, description="multiplies the time for display (1000: ms)")

    @model_validator(mode="after")
    def _of_a_body(self) -> Self:
        if self.column in (*POSITIONS, *SPEEDS, "clearance") and self.body is None:
            raise sentence_error(f"column {self.column} is of a body; expected key `body`")
        if self.column == "clearance" and self.above is None:
            raise sentence_error("column clearance is above a plane; expected key `above`")
        return self
