"""The tables of a finished run: `results.json` and `results.csv`."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, overload

from lavendersim.durable_files import write_in_pieces

from .accuracy import PARTS, Accuracy
from .limits_reached import limits_in_words
from .run_directory import RESULTS, TABLE, Run
from .run_results import CellResult, RunResults

if TYPE_CHECKING:
    from lavendersim.measures.overhead_table import OverheadTable

    from .experiment_run import Finished

# Columns of both tables, beside the measures: what a cell cost, and how well it was solved.
COSTS = ("physics_us_per_step", "logging_us_per_step", "compile_s")
ACCURACY = ("tolerance", "worst_residual", "not_converged_steps")  # m/s, m/s, number of steps
# The largest of each in any step, and the bodies of the contact that has it.
_WORST = [name for part in PARTS for name in (f"worst_{part}", f"worst_{part}_contact")]
VIOLATIONS = tuple(name for name in _WORST if name not in ACCURACY)


class _Rows(Sequence[CellResult]):
    """What a run says of its cells; a row is made when it is asked for, and not kept."""

    def __init__(self, finished: Finished, measured: Sequence[dict[str, Any]]) -> None:
        self._cells, self._outcomes = finished.run.cells, finished.outcomes
        self._measured = measured

    def __len__(self) -> int:
        return len(self._cells)

    @overload
    def __getitem__(self, place: int) -> CellResult: ...

    @overload
    def __getitem__(self, place: slice) -> list[CellResult]: ...

    def __getitem__(self, place: int | slice) -> CellResult | list[CellResult]:
        if isinstance(place, slice):
            return [self[one] for one in range(*place.indices(len(self)))]
        cell, outcome = self._cells[place], self._outcomes[place]
        steps = max(outcome.steps, 1)
        return CellResult(
            cell.index,
            cell.label,
            outcome.status,
            outcome.steps,
            self._measured[place],
            outcome.physics_ns / steps / 1000,
            outcome.logging_ns / steps / 1000,
            outcome.compile_ns / 1e9,
            outcome.accuracy.tolerance,
            outcome.accuracy.worst_residual,
            outcome.accuracy.not_converged,
            _violations(outcome.accuracy),
            outcome.accuracy.at_limit,
        )


def write_results(
    finished: Finished, measured: list[dict[str, Any]], overheads: OverheadTable | None = None
) -> None:
    """Write the tables of a finished run; numbers keep all their digits."""
    run = finished.run
    rows = _Rows(finished, measured)
    results = RunResults(
        run.name,
        run.experiment.options.reduced,
        run.experiment.options.solver,
        rows,
        compile_seconds(finished),
        finished.verdicts,
        finished.good,
        None if overheads is None else overheads.as_data(),
    )
    results.write(run.path / RESULTS)
    write_in_pieces(run.path / TABLE, _lines_of(run, rows), flush=False)


def _violations(accuracy: Accuracy) -> dict[str, Any]:
    """Return the columns VIOLATIONS; None for what the log does not have."""
    found: dict[str, Any] = {}
    for part in PARTS:
        worst = accuracy.worst.get(part)
        found[f"worst_{part}"] = worst.value if worst else None
        found[f"worst_{part}_contact"] = worst.bodies or None if worst else None
    return {name: found[name] for name in VIOLATIONS}


def compile_seconds(finished: Finished) -> float:
    """Return what composing, compiling and loading kernels took in all [s]."""
    # Cells that are the same simulation share one outcome.
    once = {
        cell.path: outcome.compile_ns
        for cell, outcome in zip(finished.run.cells, finished.outcomes, strict=True)
    }
    total: float = sum(once.values()) / 1e9
    return total


def convergence_notices(finished: Finished) -> list[str]:
    """Return sentences for every cell with steps that did not converge to its tolerance.

    And for those in which an algorithm took all its iterations.
    """
    notices = []
    for cell, outcome in zip(finished.run.cells, finished.outcomes, strict=True):
        accuracy = outcome.accuracy
        if accuracy.not_converged:
            where = f"[{cell.label}]" if cell.label else ""
            notices.append(
                f"{finished.run.name}{where}: {accuracy.not_converged} of {outcome.steps} steps "
                f"ended above the tolerance {accuracy.tolerance:g} m/s, "
                f"worst {accuracy.worst_residual:.2g} m/s"
            )
        if accuracy.at_limit:
            where = f"[{cell.label}]" if cell.label else ""
            notices.append(f"{finished.run.name}{where}: {limits_in_words(accuracy.at_limit)}")
    return notices


def _lines_of(run: Run, rows: Sequence[CellResult]) -> Iterator[str]:
    names, axes = list(run.experiment.measures), list(run.experiment.axes)
    yield _line(["cell", *axes, "status", "steps", *names, *COSTS, *ACCURACY, *VIOLATIONS])
    for cell, row in zip(run.cells, rows, strict=True):
        coordinates = [str(cell.coordinates.get(axis, "")) for axis in axes]
        values = [row.measures.get(name, "") for name in names]
        yield _line(
            [cell.label, *coordinates, row.status, row.steps, *values]
            + [getattr(row, name) for name in (*COSTS, *ACCURACY)]
            + [row.violations[name] for name in VIOLATIONS]
        )


def _line(values: Sequence[Any]) -> str:
    text = io.StringIO()
    csv.writer(text).writerow(values)
    return text.getvalue()
