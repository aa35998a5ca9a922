"""Models of measures of what connects bodies: ropes and joints."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import JointName, RopeName
from lavendersim.quantities.readings import CONTACTS


class Tension(Measure):
    """Force [N] by which a rope pulls at the end of the run; 0 in steps in which it is slack."""

    READS = CONTACTS
    NO_NUMBER = "its window is longer than the run, or neither body moves"
    kind: Literal["tension"]
    connection: RopeName = Field(description="name of the rope")
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    statistic: Literal["mean", "largest"] = Field(
        default="mean", description="mean of the window, or the largest of a step in it"
    )


class JointForce(Measure):
    """Magnitude of the force [N] that a joint passes on at the end of the run."""

    READS = CONTACTS
    NO_NUMBER = "its window is longer than the run, or neither body moves"
    kind: Literal["joint_force"]
    connection: JointName = Field(description="name of the joint")
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    statistic: Literal["mean", "largest"] = Field(
        default="mean", description="magnitude of the window's mean force, or its largest of a step"
    )


class JointTorque(Measure):
    """Magnitude of the torque [N m] about its `at` that a joint passes on as the run ends."""

    READS = CONTACTS
    NO_NUMBER = "its window is longer than the run, or neither body moves"
    kind: Literal["joint_torque"]
    connection: JointName = Field(description="name of the joint")
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    statistic: Literal["mean", "largest"] = Field(
        default="mean",
        description="magnitude of the window's mean torque, or its largest of a step",
    )
