"""What of an experiment is suspicious: every rule, over the first cell with each swept value."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from typing import Final

from lavendersim.errors import ConfigError, Defect, SuspiciousScene
from lavendersim.experiment import Cell, Experiment
from lavendersim.lint.captured_ahead import captured_ahead
from lavendersim.lint.crossing import crossing
from lavendersim.lint.one_sided import one_sided
from lavendersim.lint.overlaps import overlaps
from lavendersim.lint.unused import unclaimed, unused_constants, unused_shapes, unused_surfaces

OF_CELLS: Final[tuple[Callable[[Cell], Iterator[Defect]], ...]] = (
    one_sided,
    overlaps,
    crossing,
    captured_ahead,
)
OF_FILES: Final[tuple[Callable[[Experiment], Iterator[Defect]], ...]] = (
    unclaimed,
    unused_surfaces,
    unused_shapes,
    unused_constants,
)
MOST_CELLS: Final = 100  # that are looked at; a rule takes some 0.1 ms for a small one


def suspicions(experiment: Experiment) -> list[Defect]:
    """Return what is suspicious, one sentence a place, in the order of the file."""
    found: dict[tuple[str, int, int], Defect] = {}
    of_file = (defect for rule in OF_FILES for defect in rule(experiment))
    of_cells = (
        defect for cell in _sampled(experiment) for rule in OF_CELLS for defect in rule(cell)
    )
    for defects in (of_file, of_cells):
        for defect in defects:
            found.setdefault((defect.file, defect.line, defect.column), defect)
    return [found[place] for place in sorted(found)]


def warn(experiment: Experiment, strict: bool = False) -> None:
    """Give a `SuspiciousScene` warning for each suspicion; strict: ConfigError with all of them."""
    defects = suspicions(experiment)
    if strict and defects:
        raise ConfigError(defects)
    for defect in defects:
        message = defect._replace(message=f"warning: {defect.message}")
        warnings.warn_explicit(str(message), SuspiciousScene, defect.file, defect.line)


def _sampled(experiment: Experiment) -> Iterator[Cell]:
    """Yield the first cell, and for each value of each axis the first cell that has it."""
    seen: set[tuple[str, object]] = set()
    count = 0
    for cell in experiment.cells():
        new = set(cell.coordinates.items()) - seen
        if new or cell.index == 0:
            seen |= new
            count += 1
            yield cell
        if count == MOST_CELLS:
            return
