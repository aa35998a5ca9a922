"""Models of measures that compare a log with a law: balance, conservation, the laws of contact.

They read the log's sums (energies, momenta) and poses; what they are compared with is computed
from the config alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pydantic import Field

from lavendersim.measures.specs.base import Measure, Seconds
from lavendersim.quantities.names import BodyName, PlaneName
from lavendersim.quantities.readings import CONTACTS, POSES, SUMS, Readings


class ForceError(Measure):
    """Largest |vertical contact force / weight - 1| [-] of what rests, in any step of a window."""

    READS = CONTACTS
    NO_NUMBER = "nothing of it has a weight, or the window is longer than the run"
    kind: Literal["force_error"]
    body: BodyName | None = Field(
        default=None,
        description="one body and all its contacts; all movable bodies together when absent",
    )
    last: Seconds = Field(default=1.0, description="length of the window at the end [s]")


class _EnergyChange(Measure):
    """What the measures of the energy of a scene that keeps it have in common."""

    body: BodyName | None = Field(
        default=None, description="with `above`: the only movable body; it is at rest on the plane"
    )
    above: PlaneName | None = Field(
        default=None, description="where its potential energy is zero; the world's origin if absent"
    )

    @classmethod
    def reads(cls, given: Mapping[str, str | None]) -> Readings:
        """Its height above the plane, where it is given one."""
        return POSES if "above" in given else SUMS


class EnergyDrift(_EnergyChange):
    """Largest |E/E0 - 1| [-] of the scene's kinetic and potential energy over the run."""

    NO_NUMBER = "the run begins without energy"
    kind: Literal["energy_drift"]


class EnergyGain(_EnergyChange):
    """Largest E/E0 - 1 [-] over the run: above 0 where energy was gained."""

    NO_NUMBER = "the run begins without energy"
    kind: Literal["energy_gain"]


class AngularMomentumDrift(Measure):
    """Largest |L - L0| / |L0| [-] of the scene's angular momentum vector over the run.

    A periodic cell does not keep it: what acts across a face turns it by a period times the force.
    """

    READS = SUMS
    NO_NUMBER = "nothing turns"
    kind: Literal["angular_momentum_drift"]


class LawViolation(Measure):
    """Largest violation of one part of the law of contact in any step, as `/step` reports it.

    natural_map [m/s] of the law that was solved, the solver's own error; signorini [m/s],
    cone [N s] and dissipation [J] of Signorini's and Coulomb's law, whichever was solved.
    """

    READS = SUMS
    NO_NUMBER = "no step ends behind that time, or nothing can touch"
    kind: Literal["law_violation"]
    part: Literal["natural_map", "signorini", "cone", "dissipation"] = Field(
        description="which part of the law"
    )
    after: Seconds = Field(default=0.0, description="[s] only steps that end after this time")


class NotConvergedSteps(Measure):
    """Number of steps that did not converge: their residual stayed above the tolerance."""

    READS = SUMS
    NO_NUMBER = "no tolerance is asked for"
    kind: Literal["not_converged_steps"]
