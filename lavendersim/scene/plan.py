"""A resolved config enters; the plan leaves: which effects the scene calls for, and why."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS, BodyFacts, Decision, Facts, PairFacts
from lavendersim.engine.spec import Spec
from lavendersim.errors import UsageError

from .mass_properties import mass_properties

_PAIR_BY_SHAPES = {shapes: name for name, (_, shapes, _) in SHAPE_PAIRS.items()}


class Plan(NamedTuple):
    """The structure of the engine for a scene and the reason for every choice."""

    spec: Spec
    decisions: dict[str, Decision]


class CandidatePair(NamedTuple):
    """Two bodies that may touch: rows of the body table in the order of the pair's kernel."""

    a: int
    b: int
    shape_pair: str
    restitution: float
    compliance: float


def is_movable(body: dict[str, Any]) -> bool:
    """Whether a body of a resolved config can move."""
    return body["shape"]["kind"] != "plane" and not body["fixed"]


def candidate_pairs(bodies: list[dict[str, Any]]) -> list[CandidatePair]:
    """Return every pair with a movable body, in the order of the config.

    Mixing: restitution of a pair is the larger of its surfaces', compliances add (in series).
    """
    pairs = []
    for i in range(len(bodies)):
        for j in range(i + 1, len(bodies)):
            if not (is_movable(bodies[i]) or is_movable(bodies[j])):
                continue
            a, b = i, j
            kinds = (bodies[a]["shape"]["kind"], bodies[b]["shape"]["kind"])
            if kinds not in _PAIR_BY_SHAPES:
                a, b, kinds = b, a, (kinds[1], kinds[0])
            surfaces = [bodies[k]["surface"] for k in (a, b)]
            pairs.append(
                CandidatePair(
                    a,
                    b,
                    _PAIR_BY_SHAPES[kinds],
                    max(float(surface["restitution"]) for surface in surfaces),
                    sum(float(surface["compliance"]) for surface in surfaces),
                )
            )
    return pairs


def _body_facts(name: str, body: dict[str, Any]) -> BodyFacts:
    movable = is_movable(body)
    uniform = True
    if movable:
        inertia = mass_properties(body["shape"], body["mass"]).inertia
        uniform = inertia[0] == inertia[1] == inertia[2]
    return BodyFacts(name, body["shape"]["kind"], movable, any(body["angular_velocity"]), uniform)


def facts_of(resolved: dict[str, Any]) -> Facts:
    """Reduce a resolved config to what the effects' predicates ask."""
    names = list(resolved["scene"]["bodies"])
    bodies = list(resolved["scene"]["bodies"].values())
    numerics = resolved["numerics"]
    gx, gy, gz = (float(g) for g in resolved["scene"]["gravity"])
    return Facts(
        bodies=tuple(_body_facts(name, body) for name, body in zip(names, bodies, strict=True)),
        pairs=tuple(
            PairFacts(names[pair.a], names[pair.b], pair.restitution, pair.compliance)
            for pair in candidate_pairs(bodies)
        ),
        gravity=(gx, gy, gz),
        stabilisation_gain=float(numerics["stabilisation_gain"]),
        projection=float(numerics["projection"]) if numerics["projection_sweeps"] else 0.0,
        warm_start=bool(numerics["warm_start"]),
    )


def plan_of(resolved: dict[str, Any], record: bool = True) -> Plan:
    """Derive the plan of one cell from its resolved config alone."""
    facts = facts_of(resolved)
    decisions = {effect.NAME: effect.wanted(facts) for effect in EFFECTS}
    pairs = candidate_pairs(list(resolved["scene"]["bodies"].values()))
    return Plan(
        Spec(
            effects=tuple(sorted(name for name, decision in decisions.items() if decision.on)),
            shape_pairs=tuple(sorted({pair.shape_pair for pair in pairs})),
            solver=resolved["numerics"]["solver"],
            record=record,
            record_residuals=record and resolved["record"]["residuals"] != "none",
            tolerance=resolved["numerics"]["tolerance"] is not None,
        ),
        decisions,
    )


def union(plans: Iterable[Plan]) -> Plan:
    """Return the plan for every cell of a sweep: an effect is on where any cell wants it."""
    plans = list(plans)
    first = plans[0]
    if any(plan.spec.solver != first.spec.solver for plan in plans):
        raise UsageError("the cells of one sweep share their solver")
    decisions = dict(first.decisions)
    for plan in plans[1:]:
        for name, decision in plan.decisions.items():
            if decision.on and not decisions[name].on:
                decisions[name] = decision
    return Plan(
        Spec(
            effects=tuple(sorted(name for name, decision in decisions.items() if decision.on)),
            shape_pairs=tuple(sorted({pair for plan in plans for pair in plan.spec.shape_pairs})),
            solver=first.spec.solver,
            record=any(plan.spec.record for plan in plans),
            record_residuals=any(plan.spec.record_residuals for plan in plans),
            tolerance=any(plan.spec.tolerance for plan in plans),
        ),
        decisions,
    )
