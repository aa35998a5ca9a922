"""A config reduced to what the effects' predicates may know of it."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from lavendersim.cell import CellConfig, CellEvent, CellShape
from lavendersim.engine.effects import EFFECTS, BodyFacts, Facts, PairFacts
from lavendersim.geometry.bodies import is_movable
from lavendersim.geometry.shapes import bounding_radius

from .classes import class_pairs
from .colliders import colliders, parts_of


def changes_of_bodies(config: CellConfig) -> list[CellEvent]:
    """Return the events that change a body."""
    return [event for event in config.events if isinstance(event, CellEvent)]


def _body_facts(config: CellConfig) -> Iterator[BodyFacts]:
    events: dict[str, list[CellEvent]] = {}
    for event in changes_of_bodies(config):
        events.setdefault(event.body, []).append(event)
    pushed = {force.body for force in config.scene.forces if any(force.force)}
    twisted = {force.body for force in config.scene.forces if any(force.torque)}
    levers = {force.body for force in config.scene.forces if any(force.point)}
    acting = [one for effect in EFFECTS if effect.acts_on for one in effect.acts_on(config.scene)]
    pulled = {name for name, _ in acting}
    moving = [effect.moves for effect in EFFECTS if effect.moves]
    turned = levers | {name for name, turns in acting if turns}
    for name, body in config.scene.bodies.items():
        inertia = body.inertia or (0.0, 0.0, 0.0)
        own = events.get(name, ())
        speeds = [body.velocity, *(event.velocity or () for event in own)]
        spins = [body.angular_velocity, *(event.angular_velocity or () for event in own)]
        driven = [moves(body) for moves in moving]
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
            force=name in pushed,
            torque=name in twisted,
            pulled=name in pulled,
            twisted=name in turned,
            parts=len(parts_of(body.shape)),
        )


def _least_size(shape: CellShape) -> float:
    """Return the bounding radius of the smallest thing that collides [m]."""
    sizes = [bounding_radius(part.shape) for part in parts_of(shape)]
    return min(sizes) if sizes else bounding_radius(shape)


def facts_of(config: CellConfig, record: bool = True) -> Facts:
    """Reduce a config to what the effects' predicates ask; record: it is to be logged."""
    names = list(config.scene.bodies)
    rows = colliders(list(config.scene.bodies.values()))
    numerics = config.numerics
    pairs = class_pairs(rows)
    return Facts(
        bodies=tuple(_body_facts(config)),
        pairs=tuple(
            PairFacts(
                a=names[rows[pair.a].owner],
                b=names[rows[pair.b].owner],
                shape_pair=pair.shape_pair,
                row_pairs=pair.row_pairs,
                surface=pair.surface,
            )
            for pair in pairs
        ),
        gravity=config.scene.gravity,
        stabilisation_gain=numerics.stabilisation_gain,
        projection=numerics.projection if numerics.projection_sweeps else 0.0,
        warm_start=numerics.warm_start,
        pair_count=sum(pair.row_pairs for pair in pairs),
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
        scene=config.scene,
        sleeping=numerics.sleeping,
        events=bool(changes_of_bodies(config)),
        record=record,
        residuals=config.record.residuals != "none",
        problems=config.record.problems != "none",
        timestep=float(config.clock.longest),
        duration=config.duration,
    )
