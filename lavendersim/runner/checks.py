"""What is checked of an experiment before anything of it runs, beyond what its file alone shows.

Names of effects under `overhead`, effects switched by hand, contact problems to be written: these
depend on the plan of the scene and on what is installed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from lavendersim.cell.record import NONE
from lavendersim.errors import ConfigError, Defect
from lavendersim.experiment import Experiment
from lavendersim.peers.catalogue import LAVENDER, missing

Check = Callable[[Experiment], None]


def check(experiment: Experiment) -> None:
    """Raise ConfigError with every defect that keeps an experiment from being run."""
    defects: dict[Defect, None] = {}  # an effect that cannot be off is met by two checks
    for one in _checks_of(experiment):
        try:
            one(experiment)
        except ConfigError as error:
            defects |= dict.fromkeys(error.defects)
    if defects:
        raise ConfigError(sorted(defects, key=lambda defect: (defect.line, defect.column)))


def _checks_of(experiment: Experiment) -> Iterator[Check]:
    """Yield the checks that an experiment requires; late, as others are checked without numba."""
    if experiment.config.overhead is not None:
        from .overheads import check_overheads

        yield check_overheads
    if any(name != LAVENDER for name in experiment.engines):
        yield check_installed
    if experiment.switches_effects:
        from .plans import check_overrides

        yield check_overrides
    if experiment.config.record.problems != NONE:
        from .problem_dump import check_problems

        yield check_problems


def check_installed(experiment: Experiment) -> None:
    """Raise ConfigError where a cell names an engine that is not installed, or is not its own."""
    defects: dict[Defect, None] = {}
    for cell in experiment.cells():
        if cell.config.engine is not None and (why := missing(cell.config.engine.name)):
            defects[cell.defect(("engine",), f"engine: {why}")] = None
    if defects:
        raise ConfigError(sorted(defects))
