"""The time error of a run's measures: every cell again at half and a quarter of its timestep.

The finer runs lie in the run's directory under `refined`; what they show, in `time_errors.csv`.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, NamedTuple

from lavendersim.durable_files import write_whole
from lavendersim.errors import LavenderError
from lavendersim.measures import applies
from lavendersim.measures.cell_judgements import room
from lavendersim.measures.selection import select
from lavendersim.measures.time_errors import DIVISORS, TimeError, time_error_of

from .experiment_run import Finished, run
from .progress import Progress
from .run_directory import REFINED, TIME_ERRORS, RunCell
from .run_results import CellResult

# Gives a Progress for a run of some name.
Reporting = Callable[[str], AbstractContextManager[Progress]]
COLUMNS = ("measure", "cell", "timestep", *(f"at_1_{divisor}" for divisor in DIVISORS))
ESTIMATES = ("change", "order", "extrapolated", "bar", "error", "tolerance", "exceeds", "note")


class Refined(NamedTuple):
    """One measure of one cell."""

    measure: str
    cell: RunCell
    found: TimeError
    tolerance: float | None  # the least that a claim on it leaves, in the measure's unit
    claim: str  # which one that is; "" where there is none

    @property
    def exceeds(self) -> bool:
        """Whether half the timestep changes the number by more than a claim on it leaves."""
        return self.tolerance is not None and not abs(self.found.change) <= self.tolerance


@contextmanager
def _silent(name: str) -> Iterator[Progress]:
    yield Progress()


def refine(finished: Finished, jobs: int = 1, reporting: Reporting = _silent) -> list[Refined]:
    """Run the cells again at finer timesteps; return every measure's time error, cell by cell.

    A measure that is no number in one of the runs, or is of a cell that did not complete in one,
    has no estimate but a note.
    """
    directory = finished.run.path
    runs = [finished]
    for divisor in DIVISORS[1:]:
        experiment = finished.run.experiment.refined(divisor)
        with reporting(f"{experiment.name} at 1/{divisor} of the timestep") as progress:
            runs.append(run(experiment, directory / REFINED, jobs, progress, overheads=False))
    tables = [one.run.results().cells for one in runs]
    rows = [
        _refined(finished, name, place, [table[place] for table in tables])
        for name, spec in finished.run.experiment.measures.items()
        for place, cell in enumerate(finished.run.cells)
        if applies(spec, cell.coordinates)
    ]
    _write(finished, rows)
    return rows


def _refined(finished: Finished, name: str, place: int, cells: list[CellResult]) -> Refined:
    cell = finished.run.cells[place]
    ended = [
        f"at 1/{divisor} of the timestep: {row.status}"
        for divisor, row in zip(DIVISORS, cells, strict=True)
        if row.status != "complete"
    ]
    values = [row.measures.get(name, "no number") for row in cells]
    found = time_error_of(ended or values)
    tolerance, claim = _room(finished, name, cell, values[0])
    return Refined(name, cell, found, tolerance, claim)


def _room(finished: Finished, name: str, cell: RunCell, value: Any) -> tuple[float | None, str]:
    """Return the least that a claim on the measure in this cell leaves, and the claim."""
    experiment = finished.run.experiment
    spec, rooms = experiment.measures[name], []
    for claim in experiment.expectations:
        if claim.measure != name or not claim.per_cell or isinstance(value, str):
            continue
        if not select([cell], spec.at, claim.at):
            continue
        try:
            left = room(claim, value, cell)
        except LavenderError:  # a closed form that has no value for this cell
            continue
        if left is not None:
            rooms.append((left, claim.name))
    return min(rooms) if rooms else (None, "")


def _write(finished: Finished, rows: list[Refined]) -> None:
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow([*COLUMNS, *ESTIMATES])
    for row in rows:
        found = row.found
        values = found.values or ("",) * len(DIVISORS)
        estimates = (found.change, found.order, found.extrapolated, found.bar, found.error)
        tolerance = "" if row.tolerance is None else row.tolerance
        where = row.measure, row.cell.label, row.cell.config.numerics.timestep
        writer.writerow([*where, *values, *estimates, tolerance, int(row.exceeds), found.note])
    write_whole(finished.run.path / TIME_ERRORS, text.getvalue())
