"""The plan of every cell of a sweep, one for all cells that can share a compiled engine.

Cells that differ in a coefficient share one compiled engine: the union of what they require. Cells
that differ in a choice between laws (`Plan.choices`: solver, integrator, shape of the cone, ...) or
in the effects that are switched by hand cannot, so they are grouped by these choices, and there is
one union, and one compilation, a group.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from lavendersim.errors import ConfigError, Defect
from lavendersim.experiment import Experiment
from lavendersim.experiment.cell import Cell
from lavendersim.scene.plan import Plan, plan_of_cell, union


def shared_plans(cells: Iterable[Cell]) -> list[Plan]:
    """Return the plan of each cell; equal choices give one and the same object.

    Raises ConfigError with every key of the file's `effects` that cannot be, in any cell.
    """
    own: list[Plan] = []
    known: dict[Any, Any] = {}
    defects: dict[Defect, None] = {}
    for cell in cells:
        try:
            own.append(_shared(plan_of_cell(cell), known))
        except ConfigError as error:
            defects |= dict.fromkeys(error.defects)
    if defects:
        raise ConfigError(list(_first_of_each_place(defects)))
    groups: dict[tuple[Any, ...], list[Plan]] = {}
    for plan in own:
        groups.setdefault(plan.choices, []).append(plan)
    shared = {choices: union(group) for choices, group in groups.items()}
    return [shared[plan.choices] for plan in own]


def _shared(plan: Plan, known: dict[Any, Any]) -> Plan:
    """Return a plan whose decisions are kept once for all cells that are decided alike.

    Every plan decides on the same effects and pairs, in one order.
    """
    decisions, pairs = plan.decisions, plan.shape_pairs
    return plan._replace(
        decisions=known.setdefault(("effects", *decisions.values()), decisions),
        shape_pairs=known.setdefault(("pairs", *pairs.values()), pairs),
    )


def distinct(plans: Iterable[Plan]) -> list[Plan]:
    """Return each plan once, in the order of their first cells."""
    return list({plan.choices: plan for plan in plans}.values())


def check_overrides(experiment: Experiment) -> None:
    """Raise ConfigError where the `effects` of a config cannot be."""
    shared_plans(experiment.cells())


def _first_of_each_place(defects: Iterable[Defect]) -> Iterator[Defect]:
    """Yield one defect a place, in the file's order: reasons differ by cell, their cause not."""
    places: dict[tuple[str, int, int], Defect] = {}
    for defect in defects:
        places.setdefault((defect.file, defect.line, defect.column), defect)
    yield from (places[place] for place in sorted(places))
