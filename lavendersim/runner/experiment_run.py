"""Runs an experiment: a directory with logs, results and verdicts.

load -> plan -> run every cell -> measure and judge -> results -> DONE -> latest
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from lavendersim.cell.record import NONE
from lavendersim.durable_files import flush_tree, path_name, write_whole, written_aside
from lavendersim.errors import UsageError
from lavendersim.experiment import Experiment, load_experiment
from lavendersim.experiment.cell import Cell
from lavendersim.garbage import uncollected
from lavendersim.measures import Values, Verdict, judge, meant_to_end_early

from .cells_index import CellsIndex, IndexRow, write_index
from .environment import environment
from .interruption import Interrupted, handled
from .json_table import text_of
from .leftovers import remove_leftovers
from .listing import TAGS, checked_tags
from .progress import Progress
from .results import compile_seconds, convergence_notices, write_results
from .resume import take_over, unfinished_run
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
    check_latest,
    point_latest,
)
from .run_index import ENDED, PENDING, logs_closed
from .run_lock import run_lock
from .run_seal import DONE, seal_of

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from .cell import CellJob
    from .cell_jobs import Prepared
    from .cell_outcome import CellOutcome, EndedCell
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
        return not self.ended_early and not any(verdict.fails for verdict in self.verdicts)

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


MOST_OVERRIDE = 40  # characters of a directory's name, for each


# What adds to a run's directory: it is given the run and the measures of its cells.
Closing = Callable[[Finished, list[dict[str, Any]]], None]


def make_directory(experiment: Experiment, root: Path, in_text: Sequence[str] = ()) -> Path:
    """Make a new directory for a run; never an existing one.

    in_text: overrides that the experiment's text has already; its name says them, too.
    """
    now = datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    options = experiment.options
    read = "\n".join((experiment.text, *options.overrides))
    digest = hashlib.sha256(read.encode("utf-8", "surrogatepass")).hexdigest()[:8]
    changed = map(_short, (*in_text, *options.overrides))
    name = path_name("-".join(filter(None, (experiment.name, options.solver, *changed))))
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


def _short(override: str) -> str:
    """Return an override as part of a directory's name: the end of its path, and its value."""
    path, _, value = override.partition("=")
    if override.startswith("sweep "):  # sweep NAME=PATH:[VALUES]
        value = value.partition(":")[2].strip("[] ")
    return re.sub(r"[^\w.=+]+", "_", f"{re.split('[. ]', path)[-1]}={value}")[:MOST_OVERRIDE]


def run(
    experiment: Experiment | Path | str | Mapping[str, Any],
    root: Path | str = RUNS,
    jobs: int = 1,
    progress: Progress = Progress(),  # noqa: B008 - immutable
    overheads: bool = True,
    closing: Closing = lambda finished, measured: None,
    *,
    resume: bool = False,
    tags: Sequence[str] = (),
    executor: Executor | None = None,
    is_predicted: bool = False,
    prepared: Prepared | None = None,
    in_text: Sequence[str] = (),
    overrides: Sequence[str] | Mapping[str, Any] = (),
) -> Finished:
    """Run every cell of an experiment and judge its expectations; take overheads where it asks.

    experiment: one that was loaded, or whatever `load_experiment` takes, with these overrides.
    root: where run directories are made. jobs: processes; the logs are the same for any number.
    overheads: false leaves out what a section `overhead` asks for. closing: called with the results
    before the run counts as finished. resume: go on with the newest run of the experiment where it
    did not finish; see `resume`. tags: words to find it by. A cell that diverges or breaks a bound
    of `always` ends there, with a readable log; the others go on. executor: runs the cells in place
    of `jobs` processes, anything with the interface of `concurrent.futures`; see `remote`.
    is_predicted: what it takes is known (`prediction`); else logs that fill the disk are warned of.
    prepared: the same experiment, where it was planned before. in_text: overrides that the
    experiment's text has already, for the name of the directory.
    """
    from .cell_jobs import prepare
    from .log_size import log_space

    if not isinstance(experiment, Experiment):
        experiment = load_experiment(experiment, overrides=overrides)
    elif overrides:
        raise UsageError("overrides belong to the config: give them to load_experiment")
    tags = checked_tags(tags)
    if executor is not None and experiment.config.record.problems != NONE:
        raise UsageError(f"{experiment.name}: record.problems is written by processes alone")
    if prepared is None or prepared.experiment is not experiment:
        with uncollected():  # plans stay
            prepared = prepare(experiment, jobs if executor is None else 1)
    root = Path(root)
    check_latest(root)
    remove_leftovers(root)
    if not is_predicted:
        space = log_space(prepared.cells, lambda: prepared.plans, experiment.text, root)
        if space.is_large:
            progress.warning(space.warning(root))
    logs = set(prepared.logs)
    before = unfinished_run(experiment, root, logs, progress.note) if resume else None
    directory = before.path if before else make_directory(experiment, root, in_text)
    with run_lock(directory):
        done = take_over(before, logs, progress.note) if before else {}
        if tags:
            write_whole(directory / TAGS, "\n".join(tags) + "\n", flush=False)
        result = complete(
            prepared,
            directory,
            done,
            jobs=jobs,
            progress=progress,
            overheads=overheads,
            closing=closing,
            executor=executor,
        )
    point_latest(directory, root)
    return result


def complete(
    prepared: Prepared,
    directory: Path,
    done: Mapping[str, EndedCell],
    *,
    jobs: int,
    progress: Progress,
    overheads: bool = True,
    closing: Closing = lambda finished, measured: None,
    executor: Executor | None = None,
) -> Finished:
    """Run the cells that are not done into a directory, judge all of them, and seal the run.

    done: those that ended before, by the names of their logs. For who holds the directory.
    """
    from .compile_times import compiling_ahead
    from .overheads import pairs_timed, specs_of, take_overheads, write_overheads
    from .plans import distinct

    experiment, cells = prepared.experiment, prepared.cells
    pairs = pairs_timed(experiment) if overheads and experiment.config.overhead else None
    if pairs is not None and (sentence := compiling_ahead(specs_of(pairs))):
        progress.note(sentence)
    (directory / "cells").mkdir(exist_ok=True)
    write_whole(directory / CONFIG, experiment.text, flush=False)
    with uncollected():  # jobs stay, and so do results
        configs = _write_resolved(directory / RESOLVED, cells)
        pending = prepared.jobs(directory)
    ended, taken, index = _run_cells(
        experiment, pending, configs, done, (executor or jobs, progress)
    )
    outcomes = [_outcome_of(job, ended) for job in pending]
    del pending, configs, ended  # of many cells they take as much as the verdicts on them
    # A cell whose process died has no measures to draw, nor a log to take them from.
    lost = {outcome.cell for outcome in outcomes if not outcome.log}
    drawn = {index: one.values for index, one in taken.items() if index not in lost}
    run = Run(directory, experiment, drawn, written=index)
    with uncollected():
        result = _judged(run, outcomes, taken)
    measured = [taken[cell.index].values for cell in result.run.cells]
    del taken
    table = None
    if pairs is not None:
        table = take_overheads(experiment, pairs, jobs, progress.timing)
        write_overheads(directory / OVERHEADS, table)
    with uncollected():
        write_results(result, measured, table)
    known = environment(*(plan.spec for plan in distinct(prepared.plans)))
    write_whole(directory / ENVIRONMENT, text_of(known), flush=False)
    closing(result, measured)
    (directory / ENDED).unlink(missing_ok=True)
    # Nothing of the run counts before this stands: logs and tables are flushed once, together.
    flush_tree(directory)
    write_whole(directory / DONE, seal_of(directory, SEALED))
    return result


def _run_cells(
    experiment: Experiment,
    pending: list[CellJob],
    configs: list[str],
    done: Mapping[str, EndedCell],
    how: tuple[int | Executor, Progress],
) -> tuple[dict[Path, CellOutcome], dict[int, Measured], CellsIndex]:
    """Return how cells ended by their logs, what was measured by the cells' indices, and the index.

    configs: the digests of theirs. done: those that ended before, by the names of their logs.
    how: in how many processes or by which executor, and who is shown it.
    """
    from .cell import measured_later
    from .cell_jobs import different
    from .executor import outcomes_of
    from .remote import run_by

    workers, progress = how
    by_log = different(pending)
    ended = {path: done[path.name].outcome for path in by_log if path.name in done}
    taken: dict[int, Measured] = {}
    for one in done.values():
        taken |= one.measured
    directory = pending[0].path.parent.parent
    # The index stands from the start, so that an interrupted run can be listed and replayed.
    write_index(directory / CELLS, _index_of(experiment, pending, configs, ended))
    progress.began(directory)
    left = [job for path, job in by_log.items() if path not in ended]
    first = bool(left) and left[0].path == pending[0].path
    if first and isinstance(workers, int):  # of others nobody here reads along
        left[0] = left[0]._replace(copy=progress.copy)
    try:  # what ends meanwhile is noted beside it: see `run_index`
        with handled():
            for path, outcome in ended.items():
                if not done[path.name].measured:
                    taken |= measured_later(by_log[path], outcome).measured
            results = (
                outcomes_of(left, workers, progress)
                if isinstance(workers, int)
                else run_by(workers, left, progress)
            )
            for job, cell in results:
                ended[job.path] = cell.outcome
                taken |= cell.measured
                progress.cell_done(len(ended), len(by_log))
    except Interrupted as end:
        # Other processes have closed logs whose results did not come.
        closed = {path.name for path in ended} | logs_closed(directory)
        whole = f"{len(closed)} of {len(by_log)} cells are whole"
        raise Interrupted(f"{experiment.name}: {end}: {whole}, {directory}") from None
    finally:
        index = _index_of(experiment, pending, configs, ended)
        index = index._replace(cells=tuple(index.cells))
        write_index(directory / CELLS, index)
    return ended, taken, index


def _outcome_of(job: CellJob, ended: Mapping[Path, CellOutcome]) -> CellOutcome:
    """Return how a cell ended; its log may be that of another cell, too."""
    outcome = ended[job.path]
    return outcome if outcome.cell == job.cell else outcome._replace(cell=job.cell)


def _judged(run: Run, outcomes: list[CellOutcome], taken: Mapping[int, Measured]) -> Finished:
    """Return a run with the verdicts on what was measured of its cells."""
    experiment = run.experiment
    values = Values(experiment.measures, run.taken)
    always = {index: one.always for index, one in taken.items()}
    claims = (experiment.measures, experiment.expectations, run.cells, values)
    judged = partial(judge, *claims, always=experiment.always, outcomes=always)
    verdicts = judged(meant_to_fail=experiment.controls)
    raw = judged() if experiment.controls else verdicts
    return Finished(run, outcomes, verdicts, raw)


def _index_of(
    experiment: Experiment,
    jobs: Iterable[CellJob],
    configs: Iterable[str],
    ended: dict[Path, CellOutcome],
) -> CellsIndex:
    """Return which cell is in which file and how it ended; `pending` for those that did not.

    configs: the digests of theirs. Rows are made while they are taken.
    """

    def row_of(cell: Cell, job: CellJob, config: str) -> IndexRow:
        outcome = ended.get(job.path)
        return IndexRow(
            cell.index,
            cell.label,
            f"cells/{job.path.name}",
            outcome.status if outcome else PENDING,
            config,
            outcome.log if outcome else None,
            {axis: _plain(value) for axis, value in cell.coordinates.items()},
        )

    rows = map(row_of, experiment.cells(), jobs, configs)
    return CellsIndex(experiment.name, experiment.config.question, experiment.options, rows)


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
