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

from . import (
    compliance,
    contact_torque,
    gravity,
    gyroscopic,
    projection,
    restitution,
    rotation,
    stabilisation,
    warm_start,
)
from .decision import BodyFacts, Decision, Facts, PairFacts

# Order matters within a stage: kernels of one stage run in this order.
EFFECTS = (
    gravity,
    rotation,
    gyroscopic,
    contact_torque,
    restitution,
    stabilisation,
    compliance,
    warm_start,
    projection,
)

__all__ = ["EFFECTS", "BodyFacts", "Decision", "Facts", "PairFacts"]
