"""Name types: a field of such a type must name what exists: a body, plane, measure, axis.

Which names exist is known to the file that is read: it is asked in the context of the validation.
"""

from __future__ import annotations

from functools import partial
from typing import Annotated, Literal

from pydantic import AfterValidator, StringConstraints, ValidationInfo

from lavendersim.quantities.quantity import sentence_error

NamedKind = Literal[
    "body", "plane", "measure", "axis", "surface", "rope", "joint", "body or arrangement"
]


def _known(kind: NamedKind, name: str, info: ValidationInfo) -> str:
    """Return the name; refuse one that the file does not define."""
    refusal = info.context.refusal_of(kind, name) if info.context is not None else None
    if refusal:
        raise sentence_error(refusal)
    return name


BodyName = Annotated[str, AfterValidator(partial(_known, "body"))]
# In a list of bodies; an arrangement stands for all that it places.
BodiesName = Annotated[str, AfterValidator(partial(_known, "body or arrangement"))]
PlaneName = Annotated[str, AfterValidator(partial(_known, "plane"))]
MeasureName = Annotated[str, AfterValidator(partial(_known, "measure"))]
AxisName = Annotated[str, AfterValidator(partial(_known, "axis"))]
RopeName = Annotated[str, AfterValidator(partial(_known, "rope"))]
JointName = Annotated[str, AfterValidator(partial(_known, "joint"))]
SurfaceName = Annotated[str, AfterValidator(partial(_known, "surface"))]

# A constant's name: it stands in formulas, where `-` subtracts.
ConstantName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_]*$", max_length=64)]

# A new name: it appears in sweep paths (no dots), in log topics, file names and test ids.
NewName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$", max_length=64)]
