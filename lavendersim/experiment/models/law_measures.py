"""Kinds of measures that hold a log against a law: balance, conservation, the laws of contact.

They read the log's sums (energies, momenta), contacts and poses; what they are held against is
computed from the config alone.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from lavendersim.experiment.models.measure_base import Measure, Seconds
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.quantity import Quantity

# |omega| dt of the step's rotation must stay small for a flip to be told from the samples around it
Flips = Annotated[int, Quantity("", minimum=1, whole=True)]


class ForceError(Measure):
    """Largest |vertical contact force / weight - 1| [-] of what rests, in any step of a window."""

    kind: Literal["force_error"]
    body: BodyName | None = Field(
        default=None,
        description="one body and all its contacts; all movable bodies together when absent",
    )
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")


class EnergyDrift(Measure):
    """Largest |E/E0 - 1| [-] of the scene's kinetic and potential energy over the run."""

    kind: Literal["energy_drift"]
    body: BodyName | None = Field(
        default=None, description="with `above`: the only movable body; it is at rest on the plane"
    )
    above: PlaneName | None = Field(
        default=None, description="where its potential energy is zero; the world's origin if absent"
    )


class EnergyGain(Measure):
    """Largest E/E0 - 1 [-] over the run: above 0 where energy was won."""

    kind: Literal["energy_gain"]
    body: BodyName | None = Field(
        default=None, description="with `above`: the only movable body; it is at rest on the plane"
    )
    above: PlaneName | None = Field(
        default=None, description="where its potential energy is zero; the world's origin if absent"
    )


class AngularMomentumDrift(Measure):
    """Largest |L - L0| / |L0| [-] of the scene's angular momentum vector over the run."""

    kind: Literal["angular_momentum_drift"]


class VelocityError(Measure):
    """Distance [m/s] from the closed form of one impact, at the end of the run.

    The larger of |v - v*| and rho |omega - omega*|, rho the radius of the body about its centre.
    """

    kind: Literal["velocity_error"]
    body: BodyName = Field(description="the body that hits; the only movable one")
    other: BodyName = Field(description="the plane or fixed body it hits")


class AngularVelocityError(Measure):
    """Largest |omega - omega*| / |omega(0)| [-], body axes, from Jacobi's free rotation."""

    kind: Literal["angular_velocity_error"]
    body: BodyName = Field(description="the free body; the only movable one")
    until: Seconds | None = Field(default=None, description="[s] the whole run when absent")


class FlipTimeError(Measure):
    """Largest distance [s] of a time at which the body flips from that of Jacobi's solution.

    A flip: the component of omega about the axis of the middle moment changes its sign.
    """

    kind: Literal["flip_time_error"]
    body: BodyName = Field(description="the free body; the only movable one")
    flips: Flips = Field(description="how many flips are compared, from the first [-]")


class Optimality(Measure):
    """The largest violation [m/s] of each contact law in any logged contact (a row of numbers).

    1 pushing, lambda_n >= 0; 2 complementarity of lambda_n and v_n + b + b_rest + gamma lambda_n;
    where there is friction also 3 the cone, |lambda_t| <= mu lambda_n; 4 sliding opposes motion.
    Numbers 2 and 4 are what exceeds the residual of their step. Impulses count in the velocity they
    give: times the inverse effective mass, or the sum of the inverse masses.
    """

    kind: Literal["optimality"]


class LawViolation(Measure):
    """Largest violation of one part of the law of contact in any step, as `/step` states it.

    natural_map [m/s] of the law that was solved, the solver's own error; signorini [m/s],
    cone [N s] and dissipation [J] of Signorini's and Coulomb's law, whichever was solved.
    """

    kind: Literal["law_violation"]
    part: Literal["natural_map", "signorini", "cone", "dissipation"] = Field(
        description="which part of the law"
    )
    after: Seconds = Field(default=0.0, description="[s] only steps that end after this time")


class UnsolvedSteps(Measure):
    """Number of steps whose residual stayed above the tolerance asked for."""

    kind: Literal["unsolved_steps"]


LawSpec = (
    ForceError
    | EnergyDrift
    | EnergyGain
    | AngularMomentumDrift
    | VelocityError
    | AngularVelocityError
    | FlipTimeError
    | Optimality
    | LawViolation
    | UnsolvedSteps
)
