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
from lavendersim.experiment.cell import Cell, alike
from lavendersim.scene.plan import Plan, name_of, plan_of_cell, union
from lavendersim.scene.starts_read import StartsRead


def shared_plans(cells: Iterable[Cell]) -> list[Plan]:
    """Return the plan of each cell; equal choices give one and the same object.

    Cells that differ in how bodies start alone are planned once where no decision reads that.
    Raises ConfigError with every key of the file's `effects` that cannot be, in any cell.
    """
    cells = list(cells)
    own: dict[int, Plan] = {}  # by the ids of cells
    made: list[Plan] = []
    known: dict[Any, Any] = {}
    defects: dict[Defect, None] = {}
    for one in alike(cells):
        for plan, members in _plans_of_class(one, defects):
            made.append(_shared(plan, known))
            own |= dict.fromkeys(map(id, members), made[-1])
    if defects:
        raise ConfigError(list(_first_of_each_place(defects)))
    made.sort(key=lambda plan: plan.cells[0])  # reasons stand in the order of the cells
    groups: dict[tuple[Any, ...], list[Plan]] = {}
    for plan in made:
        groups.setdefault(plan.choices, []).append(plan)
    shared = {choices: union(group) for choices, group in groups.items()}
    return [shared[own[id(cell)].choices] for cell in cells]


def _plans_of_class(
    cells: list[Cell], defects: dict[Defect, None]
) -> Iterator[tuple[Plan, list[Cell]]]:
    """Yield the plan of cells that differ in how bodies start alone; where it matters, of each.

    defects: notes those of cells that have no plan.
    """
    starts = StartsRead()
    for number, cell in enumerate(cells):
        try:
            plan = plan_of_cell(cell, starts=None if number else starts)
        except ConfigError as error:
            defects |= dict.fromkeys(error.defects)
            if starts.any is False:
                return  # the others are refused alike
            continue
        if starts.any is False:
            yield plan.of(tuple(map(name_of, cells))), cells
            return
        yield plan, [cell]


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
