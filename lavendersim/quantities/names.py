"""Name types: a field of such a type must name a body, plane, measure or axis that exists.

Which names exist is known to the file that is read: it is asked in the context of the validation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import GetCoreSchemaHandler, StringConstraints, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from lavendersim.quantities.quantity import sentence_error

NamedKind = Literal["body", "plane", "measure", "axis", "surface"]


@dataclass(frozen=True)
class Refers:
    """Marks a text as the name of something defined elsewhere in the same file."""

    to: NamedKind

    def check(self, name: str, info: ValidationInfo) -> str:
        """Return the name; refuse one that the file does not define."""
        refusal = info.context.refusal_of(self.to, name) if info.context is not None else None
        if refusal:
            raise sentence_error(refusal)
        return name

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Check the name after its type."""
        return core_schema.with_info_after_validator_function(self.check, handler(source))


BodyName = Annotated[str, Refers("body")]
PlaneName = Annotated[str, Refers("plane")]
MeasureName = Annotated[str, Refers("measure")]
AxisName = Annotated[str, Refers("axis")]
SurfaceName = Annotated[str, Refers("surface")]

# A new name: it appears in sweep paths (no dots), in log topics, file names and test ids.
NewName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$", max_length=64)]
