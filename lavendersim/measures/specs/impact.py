"""Models of measures of an impact: rebound, impulses, forces and velocities."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, PairMeasure
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity
from lavendersim.quantities.readings import CONTACTS, SUMS


class FirstApex(Measure):
    """Surface clearance [m] at the first apex after the first contact; 0 if it never leaves."""

    NO_NUMBER = "the body touches nothing, or the run ends before its apex"
    kind: Literal["first_apex"]
    body: BodyName = Field(description="the body that rebounds")
    above: PlaneName = Field(description="the plane the clearance is taken above")


class ImpactImpulse(PairMeasure):
    """Sum of the normal impulses [N s] of the first unbroken run of pushing steps."""

    kind: Literal["impact_impulse"]


class StepImpulse(PairMeasure):
    """Sum of the normal impulses [N s] of one step."""

    NO_NUMBER = "that step is not in the log"
    kind: Literal["step_impulse"]
    step: Annotated[int, Quantity("", minimum=1, whole=True)] = Field(description="which step [-]")


class ApproachVelocity(PairMeasure):
    """Normal velocity [m/s] of the first contact before its step's solve; negative: approaching."""

    kind: Literal["approach_velocity"]


class SeparationVelocity(PairMeasure):
    """Normal velocity [m/s] of the first contact after its step's solve."""

    kind: Literal["separation_velocity"]


class InverseEffectiveMass(PairMeasure):
    """Inverse effective mass k_n [1/kg] of the first contact."""

    kind: Literal["inverse_effective_mass"]


class PeakForce(PairMeasure):
    """Largest normal force [N] on the body in any step (an average over that step)."""

    kind: Literal["peak_force"]


class StepsAboveForce(PairMeasure):
    """Number of steps whose normal force on the body exceeds a threshold."""

    kind: Literal["steps_above_force"]
    threshold: Annotated[float, Quantity("N", minimum=0)] = Field(description="threshold [N]")


class ImpulseBalance(Measure):
    """Relative distance of impulse from momentum change plus weight times time, whole scene."""

    READS = CONTACTS
    NO_NUMBER = "nothing pushes, or the run ends within the impact"
    kind: Literal["impulse_balance"]
    window: Literal["first_impact", "all"] = Field(
        default="first_impact",
        description="first_impact: the first unbroken run of pushing steps; all: the whole run",
    )


class MomentumDrift(Measure):
    """Largest change of the scene's momentum over the run, over its largest momentum."""

    READS = SUMS
    NO_NUMBER = "nothing moves"
    kind: Literal["momentum_drift"]
