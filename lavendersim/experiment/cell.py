"""One cell of the sweep: its tree is read as the models and resolved, or refused at its places."""

from __future__ import annotations

import hashlib
from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field
from typing import Any, Final

from lavendersim.cell.config import CellConfig
from lavendersim.errors import ConfigError, Defect
from lavendersim.experiment.checks.cell_limits import refuse_limits
from lavendersim.experiment.checks.messages import locate
from lavendersim.experiment.checks.reading import Reading
from lavendersim.experiment.models.always import AlwaysSection
from lavendersim.experiment.models.cost import CostSpec
from lavendersim.experiment.models.experiment import CellSource
from lavendersim.experiment.models.overhead import OverheadSpec
from lavendersim.experiment.resolve.cell import resolve_cell
from lavendersim.experiment.resolve.formulas import Computed
from lavendersim.experiment.resolve.placement import SceneError
from lavendersim.experiment.sweeps.axes import SweepPoint
from lavendersim.experiment.sweeps.numbers_of_bodies import class_of
from lavendersim.experiment.text.node import Node, Path, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.model import ConfigModel

# Sections that are no part of a cell, with rules that its values may break.
_BESIDE: Final[dict[str, type[ConfigModel]]] = {
    "always": AlwaysSection,
    "overhead": OverheadSpec,
    "cost": CostSpec,
}


def build_cell(root: Node, point: SweepPoint, report: Report) -> CellConfig | None:
    """Return the resolved config of one cell of the sweep, or None when something is wrong."""
    tree = point.tree(root, report)
    reading = Reading(tree, (), report)
    for name, model in _BESIDE.items():
        if (section := tree.entries.get(name)) is not None and section.entries:
            reading.apply(model, section, (name,))
    source = reading.read(CellSource, only=CellSource.model_fields)
    if not report.close_round() or source is None:
        return None
    reading.keep(source)
    try:
        config = resolve_cell(source)
    except SceneError as error:
        report.add(locate(tree, error.path)[1].mark, str(error))
        report.close_round()
        return None
    refuse_limits(config, tree, report)
    return config if report.close_round() else None


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of an experiment's sweep; its config is built when it is first asked for."""

    index: int
    _root: Node = field(repr=False, compare=False)
    _point: SweepPoint
    _name: str = field(repr=False, compare=False)  # of the file, for messages
    divisor: int = 1  # of the timestep that the file gives it
    _built: CellConfig | None = field(default=None, init=False, repr=False, compare=False)

    @property
    def coordinates(self) -> dict[str, Any]:
        """Axis -> swept value; ratios are Fractions."""
        return self._point.coordinates

    @property
    def label(self) -> str:
        """`e=0.8, timestep=1/480`; empty without a sweep."""
        return self._point.label

    @property
    def config(self) -> CellConfig:
        """The complete config of this cell; raises ConfigError where its values do not fit."""
        if self._built is None:
            report = Report(self._name)
            config = build_cell(self._root, self._point, report)
            if config is None:
                raise ConfigError(report.defects)
            self.keep(config if self.divisor == 1 else config.refined(self.divisor))
        assert self._built is not None
        return self._built

    @property
    def is_built(self) -> bool:
        """Whether its config was built, or kept, before."""
        return self._built is not None

    def keep(self, config: CellConfig) -> None:
        """Keep the config of this cell, which was built before."""
        object.__setattr__(self, "_built", config)  # what is frozen is what the file says

    def likeness(self, masses: bool = True) -> tuple[Hashable, ...]:
        """Return what it has in common with cells that differ in numbers of bodies alone.

        In how these start and, unless `masses` is false, in how heavy they are.
        """
        return id(self._root), self.divisor, *class_of(self._point, masses)

    @property
    def file(self) -> str:
        """The file that it is of, as messages call it."""
        return self._name

    @property
    def tree(self) -> Node:
        """What the file says of this cell: the tree with the swept values in their places."""
        return self._point.tree(self._root)

    @property
    def computed(self) -> list[Computed]:
        """Numbers of this cell from formulas that take a swept constant."""
        return self._point.computed(self._root)

    def defect(self, path: Path, message: str) -> Defect:
        """Return a defect at a key, an item or a swept value of this cell."""
        swept = self._point.nodes
        if path in swept:
            mark = swept[path].mark
        else:
            (_, parent), last = locate(self.tree, path[:-1]), path[-1]
            mark = parent.items[last].mark if isinstance(last, int) else key_mark(parent, last)
        return mark.defect(self._name, message)

    @property
    def digest(self) -> str:
        """sha256 (hex) of the resolved config; equal for equal simulations.

        Keys are not sorted: the order of bodies decides the order of contacts in the solver.
        """
        return hashlib.sha256(self.config.as_json().encode()).hexdigest()


def alike(cells: Iterable[Cell], masses: bool = True) -> list[list[Cell]]:
    """Return the cells in classes whose members differ in numbers of bodies alone.

    In how these start and, unless `masses` is false, in how heavy they are.
    """
    classes: dict[tuple[Hashable, ...], list[Cell]] = {}
    for cell in cells:
        classes.setdefault(cell.likeness(masses), []).append(cell)
    return list(classes.values())
