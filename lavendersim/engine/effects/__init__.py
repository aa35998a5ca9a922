"""Effects: one file each, with its predicate, its one-sentence reason, its fields and its kernels.

An effect's module has
    NAME, STAGE        what it is called in plans; where in the step its kernel runs
    wanted(facts)      Decision: does this scene call for it, and why, in the scene's own words
    make(spec)         its kernel, where the step calls one
and, where there is need,
    NEEDS              effects without which it cannot be
    CHOSEN_BY          the key of the numerics that chooses it: a law, no coefficient turns it off
    CHOSEN_IN          the section of that key, where it is another one
    STUDY_ONLY         of a mistake on purpose, what it does: every run that has it says so
    BODY_FIELDS, VELOCITY_FIELDS, PAIR_FIELDS, CONTACT_FIELDS, CACHE_FIELDS   columns it brings
    contact_fields(spec)   columns of contacts that depend on other effects
    body_values(body)  values of its BODY_FIELDS for one body of a resolved config, by name
    CONTACT_ROW_FIELDS with make_log(spec) -> kernel(out, contact, va, vb)
    STEP_ROW_FIELDS    with make_step_log(spec) -> kernel(row, bodies, counters)
    CHANNELS           of the log
Stages:
    accelerate   kernel(body, velocity, params), before contacts are completed
    capture      kernel(contact, pair, params), once per contact and step
    collide, integrate, match, project, record, solve   called by name from the step and the solver

An effect of the first two stages is its file and its name in EFFECTS, nothing else: see `drag`.
"""

from typing import Any

from ..records import Field
from ..spec import Spec
from . import (
    broad_phase,
    capture_in_sweeps,
    compliance,
    compound,
    contact_log,
    contact_torque,
    drag,
    external_force,
    fast_bodies,
    friction,
    gravity,
    gyroscopic,
    impact_energy,
    impact_time,
    kinematic,
    midpoint,
    newton,
    pose_log,
    problem_log,
    projection,
    residual_log,
    restitution,
    rolling_friction,
    rotation,
    sleeping,
    smooth_contact,
    speculative,
    stabilisation,
    step_log,
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
    external_force,
    drag,
    rotation,
    gyroscopic,
    kinematic,
    contact_torque,
    smooth_contact,
    friction,
    torsional_friction,
    rolling_friction,
    surface_velocity,
    midpoint,
    impact_time,
    speculative,
    fast_bodies,
    restitution,
    capture_in_sweeps,
    impact_energy,
    stabilisation,
    compliance,
    warm_start,
    newton,
    projection,
    sleeping,
    step_log,
    pose_log,
    contact_log,
    residual_log,
    problem_log,
)


def made_by(spec: Spec, maker: str, stage: str | None = None) -> list[Any]:
    """Return the kernels that a maker makes of every effect of `spec` that has it, in order."""
    return [
        getattr(effect, maker)(spec)
        for effect in EFFECTS
        if spec.has(effect.NAME) and hasattr(effect, maker) and stage in (None, effect.STAGE)
    ]


def surface_fields(spec: Spec) -> list[Field]:
    """Return the columns that surfaces bring to pairs."""
    extra = [getattr(e, "PAIR_FIELDS", []) for e in EFFECTS if spec.has(e.NAME)]
    return [field for fields in extra for field in fields]


__all__ = [
    "EFFECTS",
    "BodyFacts",
    "Decision",
    "Facts",
    "PairFacts",
    "made_by",
    "surface_fields",
]
