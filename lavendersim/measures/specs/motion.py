"""Models of measures of where bodies are, from the logged poses alone.

The solver's own columns (penetration, impulses) play no part in them.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import BodiesName, BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import POSES


class ApexError(Measure):
    """|apex / (e^(2 k) h) - 1| [-] of the k-th apex of a body dropped from the clearance h."""

    READS = POSES
    NO_NUMBER = "the run ends before that bounce's apex"
    kind: Literal["apex_error"]
    body: BodyName = Field(description="the bouncing body")
    above: PlaneName = Field(description="the plane it bounces on")
    bounce: Annotated[int, Quantity("", minimum=1, whole=True)] = Field(
        default=1, description="the apex after which bounce, k [-]"
    )


class Drift(Measure):
    """Greatest distance [m] of any centre from where it was at a given time."""

    READS = POSES
    kind: Literal["drift"]
    after: Seconds = Field(default=0.5, description="the time of the pose it is counted from [s]")
    bodies: tuple[BodiesName, ...] = Field(
        default=(),
        description="whose centres, also of arrangements; of all movable bodies when absent",
    )


class SlipDistance(Measure):
    """Distance [m] between a body's centre at the beginning and at the end of a window."""

    READS = POSES
    NO_NUMBER = "the window is longer than the run"
    kind: Literal["slip_distance"]
    body: BodyName = Field(description="the body")
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")


class Creep(Measure):
    """Mean speed [m/s] of a body over a window: `slip_distance` over the window's length."""

    READS = POSES
    NO_NUMBER = "the window is longer than the run"
    kind: Literal["creep"]
    body: BodyName = Field(description="the body")
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")


class EffectiveFriction(Measure):
    """The mu [-] that the body's mean acceleration along a plane stands for, under gravity alone.

    (g_t - a) / g_n with g_t and g_n gravity along and into the plane; the slope g_t/g_n itself for
    a body that holds.
    """

    READS = POSES
    NO_NUMBER = "gravity does not press the body on the plane, or the window is longer than the run"
    kind: Literal["effective_friction"]
    body: BodyName = Field(description="the sliding body")
    on: PlaneName = Field(description="the plane it slides on")
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")


class PassedThrough(Measure):
    """How far [m] a body's centre came behind the middle of a wall; negative: it never did.

    A plane's middle is its surface. A fixed box is looked at along the edge on which the body
    starts farthest outside it.
    """

    READS = POSES
    NO_NUMBER = "the body starts within the wall"
    kind: Literal["passed_through"]
    body: BodyName = Field(description="the body that may pass")
    wall: BodyName = Field(description="a plane or a fixed box")
