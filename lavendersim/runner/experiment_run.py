"""Runs an experiment: a directory with logs, results and verdicts.

load -> plan -> run every cell -> measure and judge -> results -> DONE -> latest
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from lavendersim.durable_files import flush_tree, write_whole, written_aside
from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.measures import Values, Verdict, judge, meant_to_end_early

from .checks import check
from .environment import environment
from .interruption import Interrupted, handled
from .json_table import text_of
from .progress import Progress
from .results import compile_seconds, convergence_notices, write_results
from .run_directory import (
    CELLS,
    CONFIG,
    ENVIRONMENT,
    OVERHEADS,
    RESOLVED,
    RUNS,
    SEALED,
    Run,
    RunCell,
    point_latest,
)
from .run_index import ENDED, PENDING, as_row
from .run_seal import DONE, seal_of
from .seeds import Seeds

if TYPE_CHECKING:
    from .cell import CellJob, CellOutcome
    from .measured import Measured


class Finished(NamedTuple):
    """A run that came to its end: where it is, how its cells ended, what was judged."""

    run: Run
    outcomes: list[CellOutcome]  # in the order of the cells
    verdicts: list[Verdict]
    raw: list[Verdict]  # on every claim, as if nothing were named by a negative control

    @property
    def good(self) -> bool:
        """Whether every cell completed that should, and every claim was met."""
        return not self.ended_early and all(verdict.passed for verdict in self.verdicts)

    @property
    def ended_early(self) -> list[RunCell]:
        """The cells that did not complete, but for those that a negative control expects so."""
        expected = meant_to_end_early(self.run.experiment.controls, self.run.cells)
        ended = [cell for cell in self.run.cells if cell.status != "complete"]
        return [cell for cell in ended if cell.index not in expected]

    @property
    def compile_s(self) -> float:
        """What composing, compiling and loading kernels took [s]; in no step's time."""
        return compile_seconds(self)

    @property
    def not_converged(self) -> list[str]:
        """A sentence for every cell whose steps did not all converge; a warning, no failure."""
        return convergence_notices(self)


# What adds to a run's directory: it is given the run and the measures of its cells.
Closing = Callable[[Finished, list[dict[str, Any]]], None]


def make_directory(experiment: Experiment, root: Path) -> Path:
    """Make a new directory for a run; never an existing one."""
    now = datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    digest = hashlib.sha256(experiment.text.encode()).hexdigest()[:8]
    name = "-".join(filter(None, (experiment.name, experiment.solver)))
    root.mkdir(parents=True, exist_ok=True)
    # A name that sorts by age even when several runs start within one second.
    for attempt in range(1000):
        stamp = now if attempt == 0 else f"{now}.{attempt:03d}"
        path = root / f"{stamp}-{name}-{digest}"
        try:
            path.mkdir()
        except FileExistsError:
            continue
        return path
    raise UsageError(f"{root}: a thousand runs started within one second")


def _file_of(cell: Cell, source: str) -> str:
    return hashlib.sha256(f"{cell.digest} {source}".encode()).hexdigest()[:16] + ".mcap"


def run(
    experiment: Experiment | Path | str,
    root: Path | str = RUNS,
    jobs: int = 1,
    progress: Progress = Progress(),  # noqa: B008 - immutable
    overheads: bool = True,
    closing: Closing = lambda finished, measured: None,
) -> Finished:
    """Run every cell of an experiment and judge its expectations; take overheads where it asks.

    root: where run directories are made. jobs: processes; the logs are the same for any number.
    overheads: false leaves out what a section `overhead` asks for. closing: called with the results
    before the run counts as finished. A cell that diverges or breaks a bound of `always` ends
    there, with a readable log; the others go on.
    """
    from lavendersim.engine.compile_options import source_hash

    from .cell import CellJob, CellOfLog
    from .executor import outcomes_of
    from .log_size import size_warning
    from .overheads import take_overheads, write_overheads
    from .plans import distinct, shared_plans

    if not isinstance(experiment, Experiment):
        experiment = load_experiment(experiment)
    check(experiment)
    cells = experiment.cells()
    plans = shared_plans(cells)
    seeds = Seeds(experiment)
    root = Path(root)
    if sentence := size_warning(cells, plans, experiment.text, root):
        progress.warning(sentence)
    directory = make_directory(experiment, root)
    (directory / "cells").mkdir()
    write_whole(directory / CONFIG, experiment.text, flush=False)
    configs = _write_resolved(directory / RESOLVED, cells)
    pending = [
        CellJob(
            cell.index,
            cell.config,
            experiment.text,
            directory / "cells" / _file_of(cell, source_hash()),
            plan,
            seeds.of(cell.coordinates),
            experiment.always,
            experiment.measures,
            (CellOfLog(cell.index, cell.label, cell.coordinates),),
        )
        for cell, plan in zip(cells, plans, strict=True)
    ]
    # Cells of several products may be the same simulation: it has one log and is run once.
    different: dict[Path, CellJob] = {}
    for job in pending:
        same = different.get(job.path)
        different[job.path] = same._replace(cells=same.cells + job.cells) if same else job
    ended: dict[Path, CellOutcome] = {}
    taken: dict[int, Measured] = {}
    # The index stands from the start, so that an interrupted run can be listed and replayed.
    _write_index(directory, experiment, zip(pending, configs, strict=True), ended)
    try:  # what ends meanwhile is noted beside it: see `run_index`
        with handled():
            for job, outcome, found in outcomes_of([*different.values()], jobs, progress):
                ended[job.path] = outcome
                taken |= found
                progress.cell_done(len(ended), len(different))
    except Interrupted as end:
        whole = f"{len(ended)} of {len(different)} cells are whole"
        raise Interrupted(f"{experiment.name}: {end}: {whole}, {directory}") from None
    finally:
        _write_index(directory, experiment, zip(pending, configs, strict=True), ended)
    (directory / ENDED).unlink(missing_ok=True)
    outcomes = [ended[job.path]._replace(cell=job.cell) for job in pending]
    # A cell whose process died has no measures to draw, nor a log to take them from.
    lost = {
        name.number for job in different.values() for name in job.cells if not ended[job.path].log
    }
    drawn = {index: one.values for index, one in taken.items() if index not in lost}
    finished = Run(directory, experiment, drawn)
    values = Values(experiment.measures, finished.taken)
    always = {index: one.always for index, one in taken.items()}
    claims = (experiment.measures, experiment.expectations, finished.cells, values)
    judged = partial(judge, *claims, always=experiment.always, outcomes=always)
    verdicts = judged(meant_to_fail=experiment.controls)
    raw = judged() if experiment.controls else verdicts
    result = Finished(finished, outcomes, verdicts, raw)
    table = None
    if overheads and experiment.config.overhead is not None:
        table = take_overheads(experiment, jobs, progress.timing)
        write_overheads(directory / OVERHEADS, table)
    measured = [taken[cell.index].values for cell in finished.cells]
    write_results(result, measured, table)
    known = environment(*(plan.spec for plan in distinct(plans)))
    write_whole(directory / ENVIRONMENT, text_of(known), flush=False)
    closing(result, measured)
    # Nothing of the run counts before this stands, so logs and tables are flushed once, together.
    flush_tree(directory)
    write_whole(directory / DONE, seal_of(directory, SEALED))
    point_latest(directory, root)
    return result


def _write_index(
    directory: Path,
    experiment: Experiment,
    jobs: Iterable[tuple[CellJob, str]],
    ended: dict[Path, CellOutcome],
) -> None:
    """Write which cell is in which file and how it ended; `pending` for those that did not.

    jobs: with the digest of the config of each.
    """
    rows = []
    for cell, (job, config) in zip(experiment.cells(), jobs, strict=True):
        outcome = ended.get(job.path)
        rows.append(
            {
                "index": cell.index,
                "label": cell.label,
                "coordinates": {axis: _plain(value) for axis, value in cell.coordinates.items()},
                "file": f"cells/{job.path.name}",
                "status": outcome.status if outcome else PENDING,
                "config": config,
                "log": as_row(outcome.log if outcome else None),
            }
        )
    table = {
        "experiment": experiment.name,
        "reduced": experiment.reduced,
        "solver": experiment.solver,
        "timestep_divisor": experiment.divisor,
        "cells": rows,
    }
    write_whole(directory / CELLS, text_of(table), flush=False)


def _write_resolved(path: Path, cells: Sequence[Cell]) -> list[str]:
    """Write the configs of all cells with every default filled in, one a line.

    Returns the SHA-256 of each, which is that of the log's attachment, too.
    """
    digests = []
    with written_aside(path, flush=False) as unfinished, unfinished.open("wb") as file:
        for number, cell in enumerate(cells):
            label = json.dumps(cell.label, ensure_ascii=False)
            opening = ",\n" if number else "[\n"
            text = f'{opening} {{"index": {cell.index}, "label": {label}, "config": '
            config = cell.config.as_json().encode()
            digests.append(hashlib.sha256(config).hexdigest())
            file.write(text.encode() + config + b"}")
        file.write(b"\n]\n")
    return digests


def _plain(value: Any) -> Any:
    return value if isinstance(value, str | int | float | bool | list | tuple) else str(value)
