"""One entry of a config's `measure` section in; a validated MeasureSpec out.

A measure turns the log of one cell into one number (or one row of numbers). What each kind
computes stands in `lavendersim/measures`, one function per kind. What all kinds may carry stands in
`measure_base`; kinds that read the logged poses in `motion_measures` and `kinematic_measures`,
kinds that compare a log with a law of mechanics in `law_measures`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.experiment.models.kinematic_measures import KinematicSpec
from lavendersim.experiment.models.law_measures import LawSpec
from lavendersim.experiment.models.measure_base import Measure, PairMeasure, Seconds
from lavendersim.experiment.models.motion_measures import MotionSpec
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity


class FirstApex(Measure):
    """Surface clearance [m] at the first apex after the first contact; 0 if it never leaves."""

    kind: Literal["first_apex"]
    body: BodyName = Field(description="the body that rebounds")
    above: PlaneName = Field(description="the plane the clearance is taken above")


class ImpactImpulse(PairMeasure):
    """Sum of the normal impulses [N s] of the first unbroken run of pushing steps."""

    kind: Literal["impact_impulse"]


class StepImpulse(PairMeasure):
    """Sum of the normal impulses [N s] of one step."""

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

    kind: Literal["impulse_balance"]
    window: Literal["first_impact", "all"] = Field(
        default="first_impact",
        description="first_impact: the first unbroken run of pushing steps; all: the whole run",
    )


class MomentumDrift(Measure):
    """Largest change of the scene's momentum over the run, over its largest momentum."""

    kind: Literal["momentum_drift"]


class SteadyForce(PairMeasure):
    """Normal force [N] on the body at the end of the run."""

    kind: Literal["steady_force"]
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    statistic: Literal["mean", "furthest"] = Field(
        default="mean", description="mean of the window, or its value furthest from that mean"
    )


class SteadyPenetration(PairMeasure):
    """Mean of the body's deepest penetration [m] at the end of the run."""

    kind: Literal["steady_penetration"]
    last: Seconds = Field(default=0.25, description="length of the window at the end [s]")
    above_slop: bool = Field(
        default=False, description="subtract the slop of the cell's numerics: d - slop [m]"
    )


class MaxPenetration(PairMeasure):
    """Deepest penetration [m] of the body in any step."""

    kind: Literal["max_penetration"]


class SettlingTime(PairMeasure):
    """Time [s] from the first contact until the penetration stays below a threshold."""

    kind: Literal["settling_time"]
    threshold: Annotated[float, Quantity("m", above=0)] = Field(description="threshold [m]")


class ResidualBySweep(Measure):
    """Residual [m/s] before sweep 1 and after each sweep (a row of numbers) of one step."""

    kind: Literal["residual_by_sweep"]
    after: Seconds = Field(description="the first step that ends after this time [s] is taken")


class FinalResidual(Measure):
    """Residual [m/s] after the last sweep of one step."""

    kind: Literal["final_residual"]
    after: Seconds = Field(description="the first step that ends after this time [s] is taken")


class EnergyByBounce(Measure):
    """Relative change of mechanical energy at the apex after bounce 1, 2, ... (a row)."""

    kind: Literal["energy_by_bounce"]
    body: BodyName = Field(description="the bouncing body; the only movable one")
    above: PlaneName = Field(description="the plane it bounces on; energy is zero at rest on it")
    bounces: Annotated[int, Quantity("", minimum=1, whole=True)] = Field(
        description="how many bounces [-]"
    )


class EnergyAfterBounces(Measure):
    """The last number of `energy_by_bounce`."""

    kind: Literal["energy_after_bounces"]
    body: BodyName = Field(description="the bouncing body; the only movable one")
    above: PlaneName = Field(description="the plane it bounces on; energy is zero at rest on it")
    bounces: Annotated[int, Quantity("", minimum=1, whole=True)] = Field(
        description="how many bounces [-]"
    )


class SimulatedDuration(Measure):
    """Simulated time [s] at the last logged step."""

    kind: Literal["simulated_duration"]


MeasureSpec = Annotated[
    FirstApex
    | ImpactImpulse
    | StepImpulse
    | ApproachVelocity
    | SeparationVelocity
    | InverseEffectiveMass
    | PeakForce
    | StepsAboveForce
    | ImpulseBalance
    | MomentumDrift
    | SteadyForce
    | SteadyPenetration
    | MaxPenetration
    | SettlingTime
    | ResidualBySweep
    | FinalResidual
    | EnergyByBounce
    | EnergyAfterBounces
    | SimulatedDuration
    | MotionSpec
    | KinematicSpec
    | LawSpec,
    Field(discriminator="kind"),
]
