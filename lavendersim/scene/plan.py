"""A resolved config enters; the plan leaves: which effects the scene calls for, and why."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final, NamedTuple

from lavendersim.engine.effects import EFFECTS, Decision
from lavendersim.engine.spec import Spec
from lavendersim.errors import UsageError

from .classes import class_pairs
from .colliders import colliders
from .facts import facts_of

# Numerics that choose between laws: no coefficient turns one engine into another's.
CHOICES: Final = ("solver", "speculative", "impacts", "integrator", "friction_cone", "sleeping")


class Plan(NamedTuple):
    """The structure of the engine for a scene and the reason for every choice."""

    spec: Spec
    decisions: dict[str, Decision]
    choices: tuple[Any, ...] = ()  # the values of CHOICES; cells that differ share no engine


def plan_of(resolved: dict[str, Any], record: bool = True) -> Plan:
    """Derive the plan of one cell from its resolved config alone."""
    facts = facts_of(resolved, record)
    decisions = {effect.NAME: effect.wanted(facts) for effect in EFFECTS}
    numerics = resolved["numerics"]
    pairs = class_pairs(colliders(list(resolved["scene"]["bodies"].values())))
    spec = Spec(
        effects=tuple(sorted(name for name, decision in decisions.items() if decision.on)),
        shape_pairs=tuple(sorted({pair.shape_pair for pair in pairs})),
        solver=numerics["solver"],
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
        tolerance=any(plan.spec.tolerance for plan in plans),
    )
    return Plan(spec, decisions, first.choices)
