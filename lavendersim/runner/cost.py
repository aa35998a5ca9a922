"""What accuracy costs: a grid of settings, each with its error against a truth and its time.

settings -> one run of all of them -> errors against the truth -> times -> front -> targets
Errors come from logs, times from engines that keep none. `cost.json` has every number and every
sample, `cost.csv` a row a setting.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from lavendersim.durable_files import write_whole
from lavendersim.engine.spec import Spec
from lavendersim.errors import ConfigError, UsageError
from lavendersim.experiment import Cell, Experiment
from lavendersim.experiment.models.cost import FEW, FEWEST_REPEATS, KNOBS
from lavendersim.experiment.sweeps.cost_grid import Setting, fragment_of, over_the_grid, settings_of
from lavendersim.experiment.sweeps.perturbed_starts import start_of
from lavendersim.measures.cost_table import CostRow, CostTable, CostTruth, ErrorSource
from lavendersim.measures.spread import Spread
from lavendersim.peers.catalogue import LAVENDER, effort_of

from .compile_times import compiling_ahead
from .cost_engines import able_engines
from .cost_errors import SettingError, SettingRun, errors_of, law_of, orders_of, runs_of
from .cost_targets import across_engines, answers, front_of_engine
from .cost_times import Clocked, Times, engine_timed, times_of
from .environment import machine
from .experiment_run import Finished, run
from .json_table import text_of
from .progress import Progress
from .run_directory import COST, COST_TABLE, RUNS
from .timed_engine import clock

if TYPE_CHECKING:
    from .cell_jobs import Prepared

NOT_TIMED: Final = "it was not timed: it ends before timing begins, or breaks off"


class Costed(NamedTuple):
    """A run of a grid, and what accuracy costs in it."""

    finished: Finished
    table: CostTable


def check_cost(experiment: Experiment, repeats: int | None = None) -> None:
    """Raise ConfigError without a section `cost`, UsageError for too few repeats, engines swept."""
    if experiment.config.cost is None:
        sentence = "no section cost: it says which measure is compared with which truth"
        raise ConfigError([experiment.cells()[0].defect(("cost",), sentence)])
    if "engine" in experiment.axes:
        raise UsageError("engines are chosen by --engine: leave out --sweep engine")
    if repeats is not None and repeats < FEWEST_REPEATS:
        raise UsageError(f"--repeats: expected {FEWEST_REPEATS} or more, found {repeats}; {FEW}")


def grid_of(experiment: Experiment, engines: Sequence[str] = ()) -> Experiment:
    """Return what is run to measure what accuracy costs: every setting, as a sweep."""
    able, _ = able_engines(experiment, engines)
    return over_the_grid(experiment, settings_of(experiment, able))


def take_cost(
    experiment: Experiment,
    root: Path | str = RUNS,
    jobs: int = 1,
    progress: Progress = Progress(),  # noqa: B008 - immutable
    targets: Sequence[float] = (),
    repeats: int | None = None,
    *,
    engines: Sequence[str] = (),
    is_quick: bool = False,
    resume: bool = False,
    is_predicted: bool = False,
    prepared: Prepared | None = None,
) -> Costed:
    """Run the grid of an experiment's `cost` section and time it.

    jobs: processes that run and compile; lavender is timed in this one. targets, repeats: in place
    of those of the config. engines: whose settings are in it; none: the config's. The run is
    finished, and `latest`, when all of it is. is_predicted: see `run`. prepared: the grid, where it
    was planned before. resume: go on with the grid's newest run where it did not finish. is_quick:
    the experiment's grid is that of `quick`, which is said beside its numbers. Interrupted while
    settings are timed, the table has the rounds that were whole.
    """
    check_cost(experiment, repeats)
    assert experiment.config.cost is not None
    able, refused = able_engines(experiment, engines)
    settings = settings_of(experiment, able)
    grid = prepared.experiment if prepared else over_the_grid(experiment, settings)
    tables: list[CostTable] = []
    each = len(experiment.cells())
    by_setting = [grid.cells()[place * each : (place + 1) * each] for place in range(len(settings))]
    timed = [one for one, setting in enumerate(settings) if setting.role != "truth"]
    specs = [engine_timed(_as_written(by_setting[one])) for one in timed]
    if sentence := compiling_ahead([spec for spec in specs if spec is not None]):
        progress.note(sentence)

    def closing(finished: Finished, measured: list[dict[str, Any]]) -> None:
        runs = runs_of(settings, finished, measured)
        errors = errors_of(experiment, runs)
        clocked = [
            _clocked(by_setting[one], runs[one], spec)
            for one, spec in zip(timed, specs, strict=True)
        ]
        spec = experiment.config.cost
        assert spec is not None
        rounds = repeats or spec.repeats
        times, taken = times_of(clocked, spec.begin, rounds, jobs, progress.timing)
        laws = [law_of(one.cells[0].config) for one in clocked]
        rows = _rows(experiment, settings, errors, times, laws)
        table = CostTable(
            experiment=experiment.name,
            config=str(experiment.path),
            overrides=list(experiment.options.overrides),
            question=experiment.config.question,
            error=ErrorSource(**spec.error.model_dump(mode="json")),
            axes=list(experiment.axes),
            cells_per_setting=each,
            clock=clock()[0],
            machine=machine(),
            repeats=taken.rounds,
            interrupted=taken.interrupted,
            quick=is_quick,
            begin=spec.begin,
            duration=experiment.cells()[0].config.duration,
            truth=_truth(settings, errors),
            rows=rows,
            targets=(found := answers(rows, targets or spec.targets)),
            refused=refused,
            sentences=across_engines(rows, found),
            efforts={} if able == (LAVENDER,) else {name: effort_of(name) for name in able},
        )
        tables.append(table)
        data = table.as_data()
        write_whole(finished.run.path / COST, text_of(data), flush=False)
        _write_csv(finished.run.path / COST_TABLE, data["rows"])

    overrides = experiment.options.overrides  # the grid's text has them
    finished = run(
        grid,
        root,
        jobs,
        progress,
        overheads=False,
        closing=closing,
        resume=resume,
        in_text=overrides,
        is_predicted=is_predicted,
        prepared=prepared,
    )
    return Costed(finished, tables[0])


def _as_written(cells: Sequence[Cell]) -> list[Cell]:
    """Return which cells of a setting are timed: those that start as written, for all others."""
    return [cell for cell in cells if not start_of(cell.coordinates)]


def _clocked(cells: Sequence[Cell], run: SettingRun, spec: Spec | None) -> Clocked:
    """Return what is timed of a setting, by its engine."""
    steps = {cell.index: one.steps for cell, one in zip(cells, run.outcomes, strict=True)}
    written = _as_written(cells)
    return Clocked(written, [steps[cell.index] for cell in written], spec)


def _rows(
    experiment: Experiment,
    settings: Sequence[Setting],
    errors: Sequence[SettingError],
    times: Sequence[Times],
    laws: Sequence[str],
) -> list[CostRow]:
    orders = orders_of(settings, [error.error for error in errors])
    rows = []
    # the truth stands last, and is not timed
    for setting, error, order, time, law in zip(
        settings, errors, orders, times, laws, strict=False
    ):
        spread = Spread.of(time.samples) if time.samples else None
        row = CostRow(
            role=setting.role,
            preset=setting.preset,
            **_numerics(setting),
            accuracy=setting.accuracy,
            error=_known(error.error),
            least_error=error.least,
            worst_at=error.worst_at,
            order=order,
            law=law,
            worst_residual=_known(error.residual),
            not_converged_steps=error.not_converged,
            steps=error.steps,
            failed=error.failed or ("" if spread else NOT_TIMED),
            ns_per_second=spread,
            samples=time.samples,
            timed_seconds=time.seconds,
            compile_s=time.compile_s,
            fragment=fragment_of(experiment, setting),
            engine=setting.engine,
            settings=dict(setting.own),
            contacts=error.counts.contacts,
            iterations=error.counts.iterations,
        )
        rows.append(row)
    families = dict.fromkeys(row.family for row in rows)
    front = {place for engine in families for place in front_of_engine(rows, engine)}
    return [replace(row, front=place in front) for place, row in enumerate(rows)]


def _truth(settings: Sequence[Setting], errors: Sequence[SettingError]) -> CostTruth | None:
    """Return what was taken for the truth, where it is a run of its own."""
    for setting, error in zip(settings, errors, strict=True):
        if setting.role == "truth":
            return CostTruth(
                **_numerics(setting),
                worst_residual=_known(error.residual),
                not_converged_steps=error.not_converged,
                steps=error.steps,
                failed=error.failed,
            )
    return None


def _numerics(setting: Setting) -> dict[str, Any]:
    return {name: getattr(setting, name) for name in KNOBS} | {"timestep": str(setting.timestep)}


def _known(number: float) -> float | None:
    """Return a number; None for those that JSON does not have."""
    return number if math.isfinite(number) else None


COLUMNS: Final = (
    *("role", "preset", "timestep", "solver", "sweeps", "tolerance", "warm_start", "accuracy"),
    *("error", "worst_at", "order", "worst_residual", "not_converged_steps", "failed", "front"),
    *("median", "lower_quartile", "upper_quartile", "low", "high", "compile_s", "law"),
    *("engine", "settings", "least_error", "contacts", "iterations"),
)


def _write_csv(path: Path, rows: Sequence[dict[str, Any]]) -> None:
    """Write a row a setting; times in ns per simulated second."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, restval="", extrasaction="ignore")
    writer.writeheader()
    for row in rows:
        writer.writerow({**row, **(row["ns_per_second"] or {})})
    write_whole(path, text.getvalue(), flush=False)
