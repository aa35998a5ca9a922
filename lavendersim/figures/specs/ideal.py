"""What a measure is compared with in a panel: a closed form, or a formula of the config's own."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from lavendersim.measures.specs.base import ClosedForm
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import NumberOrFormula, sentence_error


class Ideal(ConfigModel):
    """A closed form or a formula, drawn as a thin dark line through the cells of the panel."""

    closed_form: ClosedForm | None = Field(
        default=None, description="evaluated in every cell shown"
    )
    value: Annotated[float | str, NumberOrFormula()] | None = Field(
        default=None,
        description="or a formula of constants and axes, in the measure's unit: "
        "`5/7 * $g * sin($slope)`",
    )
    label: str = Field(min_length=1, description="its entry in the legend")

    @model_validator(mode="after")
    def _one_reference(self) -> Ideal:
        if (self.value is None) == (self.closed_form is None):
            raise sentence_error("expected exactly one of value, closed_form")
        return self
