"""Name types: a field of such a type must name a body, plane, measure or axis that exists.

The loader finds these fields by their annotation, in any model, and reports a name that does not
exist at its own line with the nearest one that does.
"""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

from pydantic import StringConstraints

NamedKind = Literal["body", "plane", "measure", "axis", "surface"]


class Refers(NamedTuple):
    """Marks a text field as the name of something defined elsewhere in the same file."""

    to: NamedKind


BodyName = Annotated[str, Refers("body")]
PlaneName = Annotated[str, Refers("plane")]
MeasureName = Annotated[str, Refers("measure")]
AxisName = Annotated[str, Refers("axis")]
SurfaceName = Annotated[str, Refers("surface")]

# A new name: it appears in sweep paths (no dots), in log topics, file names and test ids.
NewName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$", max_length=64)]
