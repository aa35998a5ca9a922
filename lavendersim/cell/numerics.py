"""Every number of the numerics: timestep, solver, stabilisation, contact cache, sleep.

The defaults are those of the preset `default` (`experiment/resolve/presets`).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated

from pydantic import Field

from lavendersim.cell.choices import FrictionCone, Impacts, Integrator, Order, Solver
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity


class Numerics(ConfigModel):
    """How a cell is simulated."""

    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)] = Field(
        default=Fraction(1, 240), description="[s] a ratio such as 1/480 is kept exactly"
    )
    solver: Solver = Field(default="adaptive", description="the solver of the contact problem")
    sweeps: Annotated[int, Quantity(whole=True, minimum=1, maximum=1_000_000)] = Field(
        default=50, description="most velocity sweeps per step"
    )
    over_relaxation: Annotated[float, Quantity(above=0, below=2)] = Field(
        default=1.0, description="factor on the changes that velocity sweeps make; 1: none"
    )
    order: Order = Field(default="coloured", description="in which sweeps visit contacts")
    tolerance: Annotated[float, Quantity("m/s", above=0)] | None = Field(
        default=1e-9, description="[m/s] residual at which sweeping stops early; null: never"
    )
    warm_start: bool = Field(default=True, description="start a solve from the cached impulses")
    # No gain: projection alone removes penetration, so resting correction never becomes bounce.
    stabilisation_gain: Annotated[float, Quantity(minimum=0)] = Field(
        default=0.0,
        description="beta: share of (penetration - slop) per step that becomes bias velocity",
    )
    slop: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=1e-7, description="[m] penetration that is left alone"
    )
    projection: Annotated[float, Quantity(minimum=0, maximum=1)] = Field(
        default=0.2, description="share of (penetration - slop) moved out per step; 0: off"
    )
    projection_sweeps: Annotated[int, Quantity(whole=True, minimum=0, maximum=1_000_000)] = Field(
        default=20, description="sweeps of the positional projection per step"
    )
    restitution_threshold: Annotated[float, Quantity("g dt", minimum=0)] = Field(
        default=2.0, description="[g dt] approach speed above which restitution acts"
    )
    cache_distance: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.02, description="[m] largest distance between a contact and its cached match"
    )
    cache_normal_cosine: Annotated[float, Quantity(minimum=-1, maximum=1)] = Field(
        default=0.95,
        description="smallest cosine between a contact's normal and its cached match's",
    )
    speculative: bool = Field(
        default=True, description="contacts are made ahead of touching; a gap may close, no more"
    )
    impacts: Impacts = Field(
        default="at_surface",
        description="when restitution acts: captured (at the start of the step that finds the "
        "contact) or at_surface (at the time within the step when the surfaces meet)",
    )
    integrator: Integrator = Field(
        default="midpoint", description="how poses follow from velocities between contacts"
    )
    friction_cone: FrictionCone = Field(
        default="disc",
        description="disc: Coulomb's law; for study pyramid: each tangent on its own; convex: the "
        "relaxation that lifts what slides",
    )
    sleeping: bool = Field(
        default=False, description="bodies that have come to rest are left out until touched"
    )
    sleep_speed: Annotated[float, Quantity("m/s", minimum=0)] = Field(
        default=0.005,
        description="[m/s] speed of every point below which a body counts as at rest",
    )
    sleep_time: Annotated[float, Quantity("s", minimum=0)] = Field(
        default=0.5, description="[s] how long a body is at rest before it sleeps"
    )
