"""A config reduced to what the effects' predicates may know of it."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import Final

from lavendersim.cell import (
    CellConfig,
    CellEvent,
    CellShape,
    changes_of_bodies,
    changes_of_gravity,
)
from lavendersim.engine.effects import (
    EFFECTS,
    BodyFacts,
    Facts,
    PairFacts,
    turned_by_joints,
)
from lavendersim.engine.effects.rope import turned as turned_by_ropes
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.shapes import bounding_radius

from .classes import class_pairs
from .colliders import colliders, parts_of
from .joints import facts_of_joints, joined_bodies
from .ropes import facts_of_ropes
from .stages import later_forms, stages_of

ACTING: Final = tuple(effect.acts_on for effect in EFFECTS if effect.acts_on)
MOVING: Final = tuple(effect.moves for effect in EFFECTS if effect.moves)


def _body_facts(config: CellConfig) -> Iterator[BodyFacts]:
    events: dict[str, list[CellEvent]] = {}
    for event in changes_of_bodies(config.planned_events):
        events.setdefault(event.body, []).append(event)
    pushed = {force.body for force in config.scene.forces if any(force.force)}
    twisted = {force.body for force in config.scene.forces if any(force.torque)}
    levers = {force.body for force in config.scene.forces if any(force.point)}
    acting = [one for acts_on in ACTING for one in acts_on(config.scene)]
    pulled = {name for name, _ in acting}
    turned = levers | {name for name, turns in acting if turns}
    turned |= {*turned_by_ropes(config.scene), *turned_by_joints(config.scene)}
    later = later_forms(config)
    for name, body in config.scene.bodies.items():
        inertia = body.inertia or (0.0, 0.0, 0.0)
        own = events.get(name, ())
        speeds = [body.velocity, *(event.velocity or () for event in own)]
        spins = [body.angular_velocity, *(event.angular_velocity or () for event in own)]
        driven = [moves(body) for moves in MOVING]
        yield BodyFacts(
            name=name,
            shape=body.shape.kind,
            movable=is_movable(body),
            spins=any(any(spin) for spin in spins) or any(turns for _, turns in driven),
            round=inertia[0] == inertia[1] == inertia[2],
            kinematic=body.kinematic,
            speed=max([*(hypot(*speed) for speed in speeds), *(speed for speed, _ in driven)]),
            size=bounding_radius(body.shape),
            least_size=_least_size(body.shape),
            config=body,
            later=later.get(name, ()),
            force=name in pushed,
            torque=name in twisted,
            pulled=name in pulled,
            twisted=name in turned,
            parts=len(parts_of(body.shape)),
            reoriented=any(event.orientation is not None for event in own),
        )


def _least_size(shape: CellShape) -> float:
    """Return the bounding radius of the smallest thing that collides [m]."""
    sizes = [bounding_radius(part.shape) for part in parts_of(shape)]
    return min(sizes) if sizes else bounding_radius(shape)


def _pairs_over_time(config: CellConfig) -> tuple[list[PairFacts[int]], int]:
    """Return the pairs of classes of all stages, each once; and how many pairs of rows may touch.

    No event lets bodies touch that could not before: the number is that of any stage.
    """
    joined = joined_bodies(config.scene)
    of_stages = [class_pairs(colliders(list(one.values())), joined) for one in stages_of(config)]
    pairs = list(of_stages[0])
    for later in of_stages[1:]:
        known = {pair[:4] for pair in pairs}
        pairs.extend(pair for pair in later if pair[:4] not in known)
    return pairs, sum(pair.row_pairs for pair in of_stages[0])


def facts_of(config: CellConfig, record: bool = True) -> Facts:
    """Reduce a config to what the effects' predicates ask; record: it is to be logged."""
    names = list(config.scene.bodies)
    numerics = config.numerics
    pairs, row_pairs = _pairs_over_time(config)
    ropes, joints = tuple(facts_of_ropes(config.scene)), tuple(facts_of_joints(config.scene))
    owners = [row.owner for row in colliders(list(config.scene.bodies.values()))]
    return Facts(
        bodies=tuple(_body_facts(config)),
        pairs=(
            *(PairFacts(names[owners[pair.a]], names[owners[pair.b]], *pair[2:]) for pair in pairs),
            *ropes,
            *joints,
        ),
        gravity=config.scene.gravity,
        triggers=tuple(one.when.text for one in config.triggered),
        later_gravity=tuple(one.gravity for one in changes_of_gravity(config.planned_events)),
        stabilisation_gain=numerics.stabilisation_gain,
        projection=numerics.projection if numerics.projection_sweeps else 0.0,
        warm_start=numerics.warm_start,
        pair_count=row_pairs + len(ropes) + sum(pair.row_pairs for pair in joints),
        speculative=numerics.speculative,
        impacts=numerics.impacts,
        simultaneous_impacts=numerics.simultaneous_impacts,
        accuracy=numerics.accuracy,
        mistake=config.study.mistake,
        integrator=numerics.integrator,
        solver=numerics.solver,
        compliance_law=numerics.compliance_law,
        undetermined_forces=numerics.undetermined_forces,
        friction_cone=numerics.friction_cone,
        order=numerics.order,
        over_relaxation=numerics.over_relaxation,
        sweeps=numerics.sweeps,
        scene=config.scene,
        sleeping=numerics.sleeping,
        events=bool(changes_of_bodies(config.planned_events)),
        record=record,
        velocities=config.record.velocities,
        residuals=config.record.residuals != "none",
        problems=config.record.problems != "none",
        timestep=float(config.clock.longest),
        duration=config.duration,
    )
