"""The angular velocity of a free body, on Jacobi's solution."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.figures.specs.base import Panel
from lavendersim.quantities.names import BodyName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import POSES

MOST_MARKERS = 100_000  # more than a picture has dots


class FreeRotation(Panel):
    """Angular velocity in body axes: Jacobi's solution as lines, the log as markers."""

    READS = POSES
    kind: Literal["free_rotation"]
    body: BodyName = Field(description="the free body; the only movable one")
    markers: Annotated[int, Quantity(whole=True, minimum=2, maximum=MOST_MARKERS)] = Field(
        default=60, description="how many logged states are marked, evenly spread [-]"
    )
