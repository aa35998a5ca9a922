"""What the rest of lavender gets from a config file: one frozen Experiment and its cells."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from lavendersim.cell.choices import NO_MISTAKE
from lavendersim.config_options import ConfigOptions
from lavendersim.experiment.cell import Cell
from lavendersim.experiment.models.axis import axis_paths
from lavendersim.experiment.models.experiment import ExperimentConfig
from lavendersim.experiment.models.tree import products
from lavendersim.experiment.resolve.formulas import Computed
from lavendersim.experiment.text.node import Node
from lavendersim.measures.specs.always import Always
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.specs.expectation import ExpectSpec


@dataclass(frozen=True)
class Experiment:
    """One validated config file."""

    name: str  # the file's stem
    path: Path
    text: str  # as written
    config: ExperimentConfig  # as written, with the first value of every axis
    axes: dict[str, tuple[Any, ...]]  # axis -> its values, over all products of the sweep
    tree: Node = field(repr=False, compare=False)  # with overrides, in this version's spelling
    _cells: tuple[Cell, ...] = field(repr=False)
    options: ConfigOptions
    computed: tuple[Computed, ...] = ()  # numbers that are the same in every cell, by formulas

    @property
    def measures(self) -> dict[str, MeasureSpec]:
        """What is taken from each log, by name."""
        return self.config.measure

    @property
    def always(self) -> Always | None:
        """What every step of every cell must keep."""
        return self.config.always

    @property
    def expectations(self) -> tuple[ExpectSpec, ...]:
        """The claims that are checked, in the order of the file."""
        return tuple(claim for claim in self.config.expect if claim.fails is None)

    @property
    def controls(self) -> tuple[ExpectSpec, ...]:
        """What must fail, in the order of the file."""
        return tuple(claim for claim in self.config.expect if claim.fails is not None)

    @property
    def unjudged(self) -> list[str]:
        """The measures of which nothing is expected."""
        judged = set(self.tree.get("expect").texts)
        return [name for name in self.measures if name not in judged]

    @property
    def is_drawn(self) -> bool:
        """Whether there is anything to draw."""
        return self.config.figure is not None or self.config.overhead is not None

    @property
    def switches_effects(self) -> bool:
        """Whether some cell switches an effect by hand, so that its plan may be refused."""
        return bool(self.config.effects.switches) or any(
            path.startswith("effects.") for path in self.swept
        )

    @property
    def engines(self) -> tuple[str, ...]:
        """The engines of its cells, by their names in the config."""
        axis = self.swept.get("engine")
        return (self.config.engine,) if axis is None else tuple(map(str, self.axes[axis]))

    @property
    def mistakes(self) -> dict[str, list[Cell]]:
        """Each deliberate error, and the cells that make it."""
        found: dict[str, list[Cell]] = {}
        if self.config.study.mistake == NO_MISTAKE and "study.mistake" not in self.swept:
            return found  # the file says nothing of mistakes: no cell need be looked at
        for cell in self._cells:
            if cell.config.study.mistake != NO_MISTAKE:
                found.setdefault(cell.config.study.mistake, []).append(cell)
        return found

    @property
    def swept(self) -> dict[str, str]:
        """The name of the axis that varies each path."""
        return {
            path: name
            for product in products(self.tree)
            for name, axis in product.entries.items()
            for path in axis_paths(axis)
        }

    def numbers(self) -> list[Computed]:
        """Return what formulas gave in the first cell, with the formulas and their places."""
        return [*self.computed, *self._cells[0].computed]

    def refined(self, divisor: int) -> Experiment:
        """Return the same experiment with every cell at timesteps of 1/divisor of its own."""
        cells = (replace(cell, divisor=cell.divisor * divisor) for cell in self._cells)
        options = self.options._replace(divisor=self.options.divisor * divisor)
        return replace(self, _cells=tuple(cells), options=options)

    def cells(self) -> tuple[Cell, ...]:
        """All cells of the sweep, the first axis slowest; one cell without a sweep."""
        return self._cells
