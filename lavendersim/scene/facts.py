"""A resolved config enters; what the effects' predicates may know of it leaves."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import Any

from lavendersim.clock import Clock
from lavendersim.engine.effects import BodyFacts, Facts, PairFacts

from .classes import class_pairs
from .colliders import bounding_radius, colliders, is_movable


def changes_of_bodies(resolved: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the events that change a body."""
    return [event for event in resolved["events"] if event.get("timestep") is None]


def _body_facts(resolved: dict[str, Any]) -> Iterator[BodyFacts]:
    events: dict[str, list[dict[str, Any]]] = {}
    for event in changes_of_bodies(resolved):
        events.setdefault(event["body"], []).append(event)
    pushed = {force["body"] for force in resolved["scene"]["forces"] if any(force["force"])}
    twisted = {force["body"] for force in resolved["scene"]["forces"] if any(force["torque"])}
    for name, body in resolved["scene"]["bodies"].items():
        inertia = body["inertia"] or (0.0, 0.0, 0.0)
        own = events.get(name, ())
        speeds = [body["velocity"], *(event["velocity"] or () for event in own)]
        spins = [body["angular_velocity"], *(event["angular_velocity"] or () for event in own)]
        yield BodyFacts(
            name=name,
            shape=body["shape"]["kind"],
            movable=is_movable(body),
            spins=any(any(spin) for spin in spins),
            round=inertia[0] == inertia[1] == inertia[2],
            kinematic=bool(body["kinematic"]),
            speed=max(hypot(*speed) for speed in speeds),
            size=bounding_radius(body["shape"]),
            least_size=_least_size(body["shape"]),
            stated=body,
            force=name in pushed,
            torque=name in twisted,
            parts=len(body["shape"].get("parts", ())),
        )


def _least_size(shape: dict[str, Any]) -> float:
    """Return the bounding radius of the smallest thing that collides [m]."""
    return min(bounding_radius(part["shape"]) for part in shape.get("parts", [{"shape": shape}]))


def facts_of(resolved: dict[str, Any], record: bool = True) -> Facts:
    """Reduce a resolved config to what the effects' predicates ask; record: it is to be logged."""
    names = list(resolved["scene"]["bodies"])
    rows = colliders(list(resolved["scene"]["bodies"].values()))
    numerics = resolved["numerics"]
    gx, gy, gz = (float(g) for g in resolved["scene"]["gravity"])
    pairs = class_pairs(rows)
    return Facts(
        bodies=tuple(_body_facts(resolved)),
        pairs=tuple(
            PairFacts(
                a=names[rows[pair.a].owner],
                b=names[rows[pair.b].owner],
                shape_pair=pair.shape_pair,
                row_pairs=pair.row_pairs,
                **pair.surface._asdict(),
            )
            for pair in pairs
        ),
        gravity=(gx, gy, gz),
        stabilisation_gain=float(numerics["stabilisation_gain"]),
        projection=float(numerics["projection"]) if numerics["projection_sweeps"] else 0.0,
        warm_start=bool(numerics["warm_start"]),
        pair_count=sum(pair.row_pairs for pair in pairs),
        speculative=bool(numerics["speculative"]),
        impacts=numerics["impacts"],
        mistake=resolved["study"]["mistake"],
        integrator=numerics["integrator"],
        solver=numerics["solver"],
        friction_cone=numerics["friction_cone"],
        sleeping=bool(numerics["sleeping"]),
        events=bool(changes_of_bodies(resolved)),
        record=record,
        residuals=resolved["record"]["residuals"] != "none",
        problems=resolved["record"]["problems"] != "none",
        timestep=float(Clock.of(resolved).longest),
        duration=float(resolved["duration"]),
    )
