"""Effects: one file each, with its predicate, its one-sentence reason, its fields and its kernels.

An effect's module has
    NAME, STAGE        what it is called in plans; where in the step its kernel runs
    wanted(facts)      Decision: does this scene call for it, and why, in the scene's own words
    BODY_FIELDS, VELOCITY_FIELDS, PAIR_FIELDS, CONTACT_FIELDS   columns it brings, if any
    make(spec)         its kernel, where the step calls one
Stages:
    accelerate   kernel(body, velocity, params), before contacts are completed
    capture      kernel(contact, pair, params), once per contact and step
    integrate, match, project, solve   called by name from `engine.step` and the solver
"""

from ..records import Field
from ..spec import Spec
from . import (
    broad_phase,
    compliance,
    compound,
    contact_torque,
    drag,
    force,
    friction,
    gravity,
    gyroscopic,
    impact_time,
    kinematic,
    midpoint,
    projection,
    restitution,
    rolling_friction,
    rotation,
    sleeping,
    speculative,
    stabilisation,
    surface_velocity,
    torsional_friction,
    warm_start,
)
from .decision import BodyFacts, Decision, Facts, PairFacts

# Order matters within a stage: kernels of one stage run in this order.
EFFECTS = (
    compound,
    broad_phase,
    gravity,
    force,
    drag,
    rotation,
    gyroscopic,
    kinematic,
    contact_torque,
    friction,
    torsional_friction,
    rolling_friction,
    surface_velocity,
    midpoint,
    impact_time,
    speculative,
    restitution,
    stabilisation,
    compliance,
    warm_start,
    projection,
    sleeping,
)


def surface_fields(spec: Spec) -> list[Field]:
    """Return the columns that surfaces bring to pairs."""
    extra = [getattr(e, "PAIR_FIELDS", []) for e in EFFECTS if spec.has(e.NAME)]
    return [field for fields in extra for field in fields]


__all__ = ["EFFECTS", "BodyFacts", "Decision", "Facts", "PairFacts", "surface_fields"]
