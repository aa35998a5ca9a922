"""The contact problems of certain steps, written as FCLIB files while a cell runs.

`record: {problems: every 10}` makes `problems/<cell>/step_000010.hdf5`, `step_000020.hdf5`, ... in
the run's directory. The impulses that the step's last solve left are FCLIB's first guess: how
well they solve the problem is for the residual to say. A step without contacts has no file.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from lavendersim.cell import CellRecord
from lavendersim.cell.record import NONE, steps_between
from lavendersim.durable_files import written_aside
from lavendersim.engine.assemble import StepProblem
from lavendersim.engine.engine import Engine
from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment
from lavendersim.scene.plan import plan_of_cell

PROBLEMS = "problems"  # beside `cells`, one folder a cell, named as the cell's log
_KEY = ("record", "problems")
_OF_NO_FILE = ("torsional_friction", "rolling_friction")


class ProblemDump:
    """Which steps of a cell are dumped, and where to."""

    def __init__(self, log: Path, record: CellRecord) -> None:
        self.every = steps_between(record.problems)
        self._log = log
        self._last = 0

    def next_stop(self, done: int, stop: int) -> int:
        """Return the step at which the engine must pause, before or at `stop`."""
        return min(stop, (done // self.every + 1) * self.every) if self.every else stop

    def take(self, engine: Engine, done: int, stop: int) -> None:
        """Write the problem of step `done`, if it is due; stop: the step the engine was sent to.

        An engine that returned before has begun to overwrite the contacts of its last step.
        """
        if not self.every or done % self.every or done != stop or done == self._last:
            return
        self._last = done
        found = engine.problem()
        if found is None or not _is_finite(found):
            return
        from lavendersim.problems.fclib import write_fclib  # late: h5py

        path = self._log.parent.parent / PROBLEMS / self._log.stem / f"step_{done:06d}.hdf5"
        with written_aside(path, flush=False) as unfinished:  # as all of the run, when it is done
            write_fclib(unfinished, found.problem, title=f"step {done}", guess=found.impulses)


def _is_finite(found: StepProblem) -> bool:
    """Whether a step that diverged left a problem at all."""
    numbers = (found.problem.blocks, found.problem.free, found.impulses)
    return all(bool(np.isfinite(one).all()) for one in numbers)


def check_problems(experiment: Experiment) -> None:
    """Raise ConfigError where a config asks for problems that cannot be written."""
    if experiment.config.record.problems == NONE:
        return
    first = experiment.cells()[0]
    if find_spec("h5py") is None:
        sentence = "record.problems needs h5py: pip install lavendersim[hdf5]"
        raise ConfigError([first.defect(_KEY, sentence)])
    sentence = next(_undumpable(experiment), "")
    if sentence:
        raise ConfigError([first.defect(_KEY, sentence)])


def _undumpable(experiment: Experiment) -> Iterator[str]:
    for cell in experiment.cells():
        plan = plan_of_cell(cell)
        for name in _OF_NO_FILE:
            if plan.requiring(name):
                what, why = name.replace("_", " "), plan.decisions[name].reason
                yield f"problems: FCLIB files have no {what}, expected none; found {why}"
