"""Every number of the numerics: timestep, solver, stabilisation, contact cache, sleep.

The defaults are those of the preset `default` (`experiment/resolve/presets`).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated

from pydantic import Field

from lavendersim.cell.choices import (
    ComplianceLaw,
    FrictionCone,
    Impacts,
    Integrator,
    Order,
    SimultaneousImpacts,
    Solver,
    UndeterminedForces,
)
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import Quantity

Timestep = Annotated[Fraction, Quantity("s", above=0, exact=True)]
Accuracy = Annotated[float, Quantity(above=0, below=1)]
Sweeps = Annotated[int, Quantity(whole=True, minimum=1, maximum=1_000_000)]
Tolerance = Annotated[float, Quantity("m/s", above=0)]


class Numerics(ConfigModel):
    """How a cell is simulated."""

    timestep: Timestep = Field(
        default=Fraction(1, 240), description="[s] a ratio such as 1/480 is kept exactly"
    )
    accuracy: Accuracy | None = Field(
        default=None,
        description="relative error that the run may have: each timestep is made in substeps "
        "whose lengths follow from their estimated errors; null: every step is one timestep long",
    )
    smallest_timestep: Annotated[float, Quantity("s", minimum=1e-10)] = Field(
        default=1e-9,
        description="[s] of substeps; a run that would need shorter ones for its accuracy ends",
    )
    solver: Solver = Field(
        default="adaptive",
        description="`projected_gauss_seidel`, `block_gauss_seidel` (its sweeps on packed "
        "contacts, faster from a few on), `coloured_gauss_seidel` (eight at a time), "
        "`nonsmooth_conjugate_gradient`, `jacobi`, `accelerated_projected_gradient`, or "
        "`adaptive`: what each step requires",
    )
    sweeps: Sweeps = Field(
        default=50,
        description="most velocity sweeps per step; one that changes nothing is the last",
    )
    over_relaxation: Annotated[float, Quantity(above=0, below=2)] = Field(
        default=1.0,
        description="factor on the changes that sweeps make; impulses are projected afterwards",
    )
    order: Order = Field(
        default="coloured",
        description="in which sweeps visit contacts: `coloured`, `forward`, `backward`, "
        "`symmetric` or `random`",
    )
    tolerance: Tolerance | None = Field(
        default=1e-9, description="[m/s] residual at which sweeping stops early; null: never"
    )
    warm_start: bool = Field(
        default=True, description="start from the cached impulses of matched contacts"
    )
    # No gain: projection alone removes penetration, so resting correction never becomes bounce.
    stabilisation_gain: Annotated[float, Quantity(minimum=0)] = Field(
        default=0.0,
        description="beta: the bias velocity is beta / dt * (penetration - slop)",
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
        default=2.0, description="[g dt] approach speed above which captured restitution acts"
    )
    cache_distance: Annotated[float, Quantity("m", minimum=0)] = Field(
        default=0.02, description="[m] largest distance between a contact and its cached match"
    )
    cache_normal_cosine: Annotated[float, Quantity(minimum=-1, maximum=1)] = Field(
        default=0.95,
        description="smallest cosine between a contact's normal and its cached match's",
    )
    speculative: bool = Field(
        default=True,
        description="contacts are made ahead of touching: a gap may close within a step, and no "
        "more",
    )
    impacts: Impacts = Field(
        default="in_order",
        description="when impacts happen: `captured`, at the start of the step that finds the "
        "contact; `at_surface`, at the time within the step when the surfaces meet, all with the "
        "velocities of its start; or `in_order`, each at its time, after those before it",
    )
    simultaneous_impacts: SimultaneousImpacts = Field(
        default="together",
        description="impacts of one instant, `in_order`: `together`, by Newton's law for all of "
        "them at once; or `pairwise`, two bodies at a time, the fastest approach first: the limit "
        "of small gaps",
    )
    integrator: Integrator = Field(
        default="midpoint_contact",
        description="`semi_implicit_euler`; `midpoint`, of poses between contacts; or "
        "`midpoint_contact`, of contacts that last, too: order 2 in time wherever nothing strikes",
    )
    compliance_law: ComplianceLaw = Field(
        default="spring",
        description="what a compliance makes of a contact: a `spring`; or, `regularised`, a softer "
        "row, whose penetration follows from stabilisation and projection",
    )
    undetermined_forces: UndeterminedForces = Field(
        default="least_norm",
        description="which impulses redundant contacts have: those of `least_norm`, the limit of "
        "equal compliances; or `as_solved`, where the solver came to its end",
    )
    friction_cone: FrictionCone = Field(
        default="disc",
        description="the law of friction: `disc`, or for study `pyramid` or `convex`; see below",
    )
    sleeping: bool = Field(
        default=False, description="bodies at rest are left out until something disturbs them"
    )
    sleep_speed: Annotated[float, Quantity("m/s", minimum=0)] = Field(
        default=0.005,
        description="[m/s] speed of every point below which a body counts as at rest",
    )
    sleep_time: Annotated[float, Quantity("s", minimum=0)] = Field(
        default=0.5, description="[s] how long a body is at rest before it sleeps"
    )
