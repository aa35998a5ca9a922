"""The half-space n.x <= offset, which has no centre and never moves."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Direction, Quantity


class Plane(ConfigModel):
    """The half-space n.x <= offset, always static."""

    kind: Literal["plane"]
    normal: Direction = Field(default=(0.0, 0.0, 1.0), description="outward normal; is normalised")
    offset: Annotated[float, Quantity("m")] = Field(
        default=0.0, description="[m] n.x of its points"
    )
