"""A resolved config enters; the plan leaves: which effects the scene calls for, and why."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from math import hypot
from typing import Any, Final, NamedTuple

from lavendersim.engine.effects import EFFECTS, BodyFacts, Decision, Facts, PairFacts
from lavendersim.engine.spec import Spec
from lavendersim.errors import UsageError

from .classes import class_of, class_pairs, mix, ordered
from .colliders import bounding_radius, colliders, is_movable

# Numerics that choose between laws: no coefficient turns one engine into another's.
CHOICES: Final = ("solver", "speculative", "impacts", "integrator", "friction_cone", "sleeping")


class Plan(NamedTuple):
    """The structure of the engine for a scene and the reason for every choice."""

    spec: Spec
    decisions: dict[str, Decision]
    choices: tuple[Any, ...] = ()  # the values of CHOICES; cells that differ share no engine


class CandidatePair(NamedTuple):
    """Two bodies that may touch: rows of the body table in the order of the pair's kernel."""

    a: int
    b: int
    shape_pair: str
    restitution: float
    compliance: float
    friction: float
    torsional_friction: float
    rolling_friction: float


def candidate_pairs(bodies: Sequence[dict[str, Any]]) -> list[CandidatePair]:
    """Return every pair of rows of which one moves, in the order of the rows; for small scenes."""
    rows = colliders(bodies)
    classes = [class_of(row) for row in rows]
    pairs = []
    for i, one in enumerate(classes):
        for j in range(i + 1, len(classes)):
            other = classes[j]
            if rows[i].owner == rows[j].owner or not one.touches(other):
                continue
            swap, name = ordered((one.kind, other.kind))
            a, b = (j, i) if swap else (i, j)
            pairs.append(CandidatePair(a, b, name, *mix(one.surface, other.surface)))
    return pairs


def _body_facts(resolved: dict[str, Any]) -> Iterator[BodyFacts]:
    events: dict[str, list[dict[str, Any]]] = {}
    for event in resolved["events"]:
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
            drag=any(body["drag"].values()),
            surface_velocity=any(body["surface_velocity"]),
            force=name in pushed,
            torque=name in twisted,
            parts=len(body["shape"].get("parts", ())),
        )


def facts_of(resolved: dict[str, Any]) -> Facts:
    """Reduce a resolved config to what the effects' predicates ask."""
    names = list(resolved["scene"]["bodies"])
    rows = colliders(list(resolved["scene"]["bodies"].values()))
    numerics = resolved["numerics"]
    gx, gy, gz = (float(g) for g in resolved["scene"]["gravity"])
    pairs = class_pairs(rows)
    return Facts(
        bodies=tuple(_body_facts(resolved)),
        pairs=tuple(
            PairFacts(
                a=names[rows[pair.a].owner], b=names[rows[pair.b].owner], **pair.surface._asdict()
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
        integrator=numerics["integrator"],
        friction_cone=numerics["friction_cone"],
        sleeping=bool(numerics["sleeping"]),
        timestep=float(Fraction(numerics["timestep"])),
        duration=float(resolved["duration"]),
    )


def plan_of(resolved: dict[str, Any], record: bool = True) -> Plan:
    """Derive the plan of one cell from its resolved config alone."""
    facts = facts_of(resolved)
    decisions = {effect.NAME: effect.wanted(facts) for effect in EFFECTS}
    numerics = resolved["numerics"]
    pairs = class_pairs(colliders(list(resolved["scene"]["bodies"].values())))
    spec = Spec(
        effects=tuple(sorted(name for name, decision in decisions.items() if decision.on)),
        shape_pairs=tuple(sorted({pair.shape_pair for pair in pairs})),
        solver=numerics["solver"],
        record=record,
        record_residuals=record and resolved["record"]["residuals"] != "none",
        tolerance=numerics["tolerance"] is not None,
        friction_cone=numerics["friction_cone"],
    )
    return Plan(spec, decisions, tuple(numerics[name] for name in CHOICES))


def union(plans: Iterable[Plan]) -> Plan:
    """Return the plan for every cell of a sweep: an effect is on where any cell wants it."""
    plans = list(plans)
    first = plans[0]
    for name, *values in zip(CHOICES, *(plan.choices for plan in plans), strict=True):
        if len(set(values)) > 1:
            raise UsageError(f"the cells of one sweep share their {name}")
    decisions = dict(first.decisions)
    for plan in plans[1:]:
        for name, decision in plan.decisions.items():
            if decision.on and not decisions[name].on:
                decisions[name] = decision
    spec = first.spec._replace(
        effects=tuple(sorted(name for name, decision in decisions.items() if decision.on)),
        shape_pairs=tuple(sorted({pair for plan in plans for pair in plan.spec.shape_pairs})),
        record=any(plan.spec.record for plan in plans),
        record_residuals=any(plan.spec.record_residuals for plan in plans),
        tolerance=any(plan.spec.tolerance for plan in plans),
    )
    return Plan(spec, decisions, first.choices)
