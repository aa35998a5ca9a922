"""What every measure of a config has in common: where it is taken and the closed form beside it.

A kind is a subclass of `Measure` with a field `kind: Literal["its_name"]`. Every kind may carry

- `at`: the cells in which the measure means something (all of them when absent), and
- `over` or `against`: a closed form; the measure then becomes the fraction value / closed form, or
  the relative distance |value / closed form - 1|.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, ClassVar, Final, Literal, Self

from pydantic import Field, ValidationInfo, model_validator

from lavendersim.measures.specs.selection import Selection
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Quantity, sentence_error
from lavendersim.quantities.readings import CONTACTS, Reader

FormName = Literal[
    "newton_impulse",
    "newton_separation_velocity",
    "inverse_effective_mass",
    "impact_speed",
    "drop_impulse",
    "rebound_height",
    "release_height",
    "weight",
    "slop",
    "steady_penetration_above_slop",
]
Seconds = Annotated[float, Quantity("s", minimum=0)]
# What the bodies of a form are, in order; one that is not here takes any number of bodies.
BODIES_OF: Final[Mapping[str, tuple[str, ...]]] = {
    **dict.fromkeys(
        ("newton_impulse", "newton_separation_velocity", "inverse_effective_mass"), ("A", "B")
    ),
    **dict.fromkeys(
        ("impact_speed", "drop_impulse", "rebound_height", "release_height"), ("body", "plane")
    ),
    "steady_penetration_above_slop": ("body", "plane"),
    "slop": (),
}


class ClosedForm(ConfigModel):
    """A named formula, evaluated from the cell's resolved config alone, never from its log."""

    form: FormName = Field(description="name of the formula (measures/closed_forms.py)")
    bodies: tuple[BodyName, ...] = Field(
        default=(), description="the bodies it speaks of, in order: (A, B), (body, plane), ..."
    )

    @model_validator(mode="after")
    def _its_bodies(self, info: ValidationInfo) -> Self:
        roles = BODIES_OF.get(self.form)
        if roles is None:
            if not self.bodies:
                raise sentence_error(f"{self.form} is of bodies, and none is named; write bodies")
            return self
        if len(self.bodies) != len(roles):
            expected = f"bodies: [{', '.join(roles)}]" if roles else "no bodies"
            raise sentence_error(f"expected {expected} of {self.form}, found {len(self.bodies)}")
        if roles[1:] == ("plane",) and info.context is not None:
            refusal = info.context.refusal_of("plane", self.bodies[1])
            if refusal:
                raise sentence_error(f"bodies of {self.form}: {refusal}")
        return self


class Measure(Reader):
    """What every kind of measure may carry."""

    NO_NUMBER: ClassVar[str] = ""  # why the log of a whole run may have none

    if TYPE_CHECKING:
        kind: str  # of each subclass a Literal of its own

    at: Selection = Field(
        default_factory=dict, description="the cells it is taken in; all when absent"
    )
    over: ClosedForm | None = Field(
        default=None, description="turn the value into value / closed form, without unit"
    )
    against: ClosedForm | None = Field(
        default=None, description="turn the value into |value / closed form - 1|, without unit"
    )

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        if self.over is not None and self.against is not None:
            raise sentence_error("expected at most one of over, against")
        return self


class PairMeasure(Measure):
    """A measure of the contacts of one body."""

    READS = CONTACTS
    NO_NUMBER = "nothing touches the body then"

    body: BodyName = Field(description="the body the measure is taken on")
    other: BodyName | None = Field(
        default=None, description="only contacts with this body; all contacts when absent"
    )
