"""The plan of every cell of a sweep, one for all cells that can share a compiled engine.

Cells that differ in a coefficient share one compiled engine: the union of what they require. Cells
that differ in a choice between laws (`Plan.choices`: solver, integrator, shape of the cone, ...) or
in the effects that are switched by hand cannot, so they are grouped by these choices, and there is
one union, and one compilation, a group.
"""

from __future__ import annotations

import itertools
from collections.abc import Hashable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from lavendersim.errors import ConfigError, Defect
from lavendersim.experiment import Experiment
from lavendersim.experiment.cell import Cell, alike
from lavendersim.scene.numbers_read import NumbersRead
from lavendersim.scene.plan import CellName, Plan, name_of, plan_of_cell, union


class Decided(NamedTuple):
    """What was decided for some cells, each by itself."""

    plans: list[Plan]  # those that differ in more than the cells they are of
    of: list[int]  # of each cell, which of them; meaningless where there are defects
    defects: tuple[Defect, ...]  # of cells that have no plan


def shared_plans(cells: Iterable[Cell]) -> list[Plan]:
    """Return the plan of each cell; equal choices give one and the same object.

    Cells that differ in how bodies start alone, or how heavy they are, are planned once where no
    decision reads that.
    Raises ConfigError with every key of the file's `effects` that cannot be, in any cell.
    """
    return joined([decided(cells)])


def decided(cells: Iterable[Cell]) -> Decided:
    """Return what the plans of some cells are, each by itself; a part of a sweep will do."""
    cells = list(cells)
    defects: dict[Defect, None] = {}
    found: dict[Hashable, tuple[int, Plan, list[CellName]]] = {}
    places: dict[int, int] = {}  # by the ids of cells
    for one in alike(cells):
        for plan, members in _plans_of_class(one, defects):
            place, _, names = found.setdefault(_decisions(plan), (len(found), plan, []))
            names += plan.cells
            places |= dict.fromkeys(map(id, members), place)
    plans = [plan.of(tuple(sorted(names))) for _, plan, names in found.values()]
    return Decided(plans, [places.get(id(cell), 0) for cell in cells], tuple(defects))


def joined(parts: Sequence[Decided]) -> list[Plan]:
    """Return the plan of each cell of a sweep, from what was decided for its parts, in order.

    Raises ConfigError, see `shared_plans`.
    """
    defects = dict.fromkeys(itertools.chain.from_iterable(part.defects for part in parts))
    if defects:
        raise ConfigError(list(_first_of_each_place(defects)))
    found: dict[Hashable, tuple[Plan, list[CellName]]] = {}
    for part in parts:
        for plan in part.plans:
            found.setdefault(_decisions(plan), (plan, []))[1].extend(plan.cells)
    made = [plan.of(tuple(sorted(names))) for plan, names in found.values()]
    made.sort(key=lambda plan: plan.cells[0])  # reasons stand in the order of the cells
    groups: dict[tuple[Any, ...], list[Plan]] = {}
    for plan in made:
        groups.setdefault(plan.choices, []).append(plan)
    shared = {choices: union(group) for choices, group in groups.items()}
    return [shared[part.plans[place].choices] for part in parts for place in part.of]


def _decisions(plan: Plan) -> Hashable:
    """Return what a plan is, but for the cells that it is of.

    Every plan decides on the same effects and pairs, in one order.
    """
    return (
        plan.spec,
        plan.choices,
        *plan.decisions.values(),
        *plan.shape_pairs.values(),
        *plan.forced.items(),
        *plan.required_by,
    )


def _plans_of_class(
    cells: list[Cell], defects: dict[Defect, None], masses: bool = True
) -> Iterator[tuple[Plan, list[Cell]]]:
    """Yield the plan of cells that differ in numbers of bodies alone; where it matters, of each.

    defects: notes those of cells that have no plan. masses: they may differ in these.
    """
    read = NumbersRead()
    for number, cell in enumerate(cells):
        try:
            plan = plan_of_cell(cell, read=None if number or len(cells) == 1 else read)
        except ConfigError as error:
            defects |= dict.fromkeys(error.defects)
            if read.none:
                return  # the others are refused alike
            continue
        if read.none:
            yield plan.of(tuple(map(name_of, cells))), cells
            return
        if read.masses and not read.starts and masses:
            for one in alike(cells, masses=False):
                yield from _plans_of_class(one, defects, masses=False)
            return
        yield plan, [cell]


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
