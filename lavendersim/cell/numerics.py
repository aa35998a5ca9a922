"""Every number of the numerics of a cell: timestep, solver, stabilisation, contact cache, sleep."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated

from lavendersim.cell.choices import FrictionCone, Impacts, Integrator, Order, Solver
from lavendersim.quantities.model import ResolvedModel
from lavendersim.quantities.quantity import Quantity


class Numerics(ResolvedModel):
    """Every number of the numerics; see `docs/config.md` for their meaning."""

    timestep: Annotated[Fraction, Quantity("s", above=0, exact=True)]  # [s]
    solver: Solver
    sweeps: int
    over_relaxation: float
    order: Order
    tolerance: float | None  # [m/s]
    warm_start: bool
    stabilisation_gain: float
    slop: float  # [m]
    projection: float
    projection_sweeps: int
    restitution_threshold: float  # [g dt]
    cache_distance: float  # [m]
    cache_normal_cosine: float
    speculative: bool
    impacts: Impacts
    integrator: Integrator
    friction_cone: FrictionCone
    sleeping: bool
    sleep_speed: float  # [m/s]
    sleep_time: float  # [s]
