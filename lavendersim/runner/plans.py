"""The cells of a sweep enter; the plan each is run by leaves, one for all cells that can share it.

Cells that differ in a coefficient share one compiled engine: the union of what they call for. Cells
that differ in a choice between laws (`Plan.choices`: solver, integrator, shape of the cone, ...)
cannot, so they are grouped by these choices, and there is one union, and one compilation, a group.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from lavendersim.scene.plan import Plan, plan_of, union


def shared_plans(cells: Iterable[dict[str, Any]]) -> list[Plan]:
    """Return the plan of each resolved cell; equal choices give one and the same object."""
    own = [plan_of(resolved) for resolved in cells]
    groups: dict[tuple[Any, ...], list[Plan]] = {}
    for plan in own:
        groups.setdefault(plan.choices, []).append(plan)
    shared = {choices: union(group) for choices, group in groups.items()}
    return [shared[plan.choices] for plan in own]


def distinct(plans: Iterable[Plan]) -> list[Plan]:
    """Return each plan once, in the order of their first cells."""
    return list({plan.choices: plan for plan in plans}.values())
