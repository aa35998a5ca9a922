"""One cell run by its plan: engine, events and bounds in one loop, block by block into the log."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from functools import cache
from pathlib import Path
from time import perf_counter_ns
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.clock import Clock
from lavendersim.engine.compile import clock_without_compiling, compiled_ns
from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import DIVERGED, INACCURATE, NOT_FINITE, RUNNING, TURNS_TOO_FAST
from lavendersim.engine.sources import source_hash
from lavendersim.engine.step_doubling import MOST_SUBSTEPS
from lavendersim.engine.together import EngineAdvance, advance_together
from lavendersim.garbage import uncollected
from lavendersim.measures import applies, outcomes_of
from lavendersim.measures.always import WorstStates
from lavendersim.measures.specs.always import Always
from lavendersim.measures.specs.catalogue import MeasureSpec
from lavendersim.measures.step_checks import checks_of
from lavendersim.measures.verdict import failure
from lavendersim.scene.build import Scene, build
from lavendersim.scene.events import EventQueue
from lavendersim.scene.plan import Plan
from lavendersim.trace import Block, Trace, TraceWriter, Written, open_trace, trace_of
from lavendersim.trace.recorded import described, partly_recorded
from lavendersim.trace.whole import INTERRUPTED

from .accuracy import Accuracy
from .bounds import Bounds
from .call_length import CALL, CallLength, block_steps
from .cell_outcome import CellOutcome, EndedCell, note_closed, note_measured
from .environment import versions
from .freed_memory import keep_freed_memory
from .in_turns import in_turns, with_growth
from .interruption import deferred, raise_noted
from .measured import Measured, measure_cell
from .problem_dump import ProblemDump
from .run_directory import RunCell
from .threads import threads_asked

# Called when the kernel of a cell is there, with what reads how many steps are done.
Began = Callable[[Callable[[], int]], None]
STOPPED: Final = -1  # beside the engine's own outcomes: a bound ended the cell
CAUSES = {
    NOT_FINITE: "is no longer finite",
    TURNS_TOO_FAST: "turns too far in one timestep for its rotation to be solved",
}
NO_SUBSTEP: Final = (
    "cannot be made as accurate as asked for ({accuracy:g}): the estimated error of a substep of "
    "{length:.3g} s is {error:.3g}, and {bound},"
)


class CellOfLog(NamedTuple):
    """A cell that a log is of; cells of several products may be the same simulation."""

    number: int  # in the sweep
    label: str
    coordinates: Mapping[str, Any]


class PlanInLog(NamedTuple):
    """What a log says of the plan of its engine, in words."""

    metadata: dict[str, dict[str, str]]
    absent: dict[str, str]  # topics that the log does without, each with the plan's reason


class CellJob(NamedTuple):
    """Everything a worker needs to run one cell; plain data, so that it can cross processes."""

    cell: int  # index in the sweep
    config: CellConfig
    as_written: str
    path: Path
    plan: Plan
    seeds: str  # of what was drawn at random, in words
    always: Always | None = None  # what every step must keep; its bounds end the cell
    measures: Mapping[str, MeasureSpec] = MappingProxyType({})
    cells: tuple[CellOfLog, ...] = ()  # that the log is measured for
    in_log: PlanInLog | None = None  # of the plan, where it is known; it is the same for many cells
    copy: Path | None = None  # of the log, for who reads along

    def alone(self) -> CellJob:
        """Return this job without what its plan says of the other cells: they may be many."""
        plan = self.plan._replace(cells=(), required_by={}, reasons={})
        return self._replace(plan=plan, in_log=self.in_log or plan_in_log(self.plan))


@cache
def _with_time(row: np.dtype[Any]) -> np.dtype[Any]:
    """Return a row of steps that has its time in the room behind it."""
    fields = [(name, row[name]) for name in row.names or ()]
    return np.dtype([*fields, ("time_ns", "i8")])


def block_of(rows: Rows, clock: Clock) -> Block:
    """Return the rows of some steps as the log takes them, with their time."""
    step = rows.step.view(_with_time(rows.step.dtype))
    step["time_ns"] = clock.nanoseconds(rows.step["step"])
    return Block(step=step, contact=rows.contact, pose=rows.pose, residual=rows.residual)


def plan_in_log(plan: Plan) -> PlanInLog:
    """Return what logs say of a plan: what is on or off, and why, and where it was overridden."""
    forced: dict[str, dict[str, str]] = {"forced": {**plan.forced}} if plan.forced else {}
    errors = {
        effect.name: f"a deliberate error: {effect.study_only}"
        for effect in EFFECTS
        if plan.spec.has(effect.name) and effect.study_only
    }
    study: dict[str, dict[str, str]] = {"study-only": errors} if errors else {}
    metadata = {
        "plan": {
            name: f"{'on' if decision.on else 'off'}: {plan.described(name)}"
            for name, decision in plan.decisions.items()
        },
        "shape pairs": {name: f"on: {plan.described(name)}" for name in plan.spec.shape_pairs},
        **forced,
        **study,
    }
    absent = {
        topic: f"{plan.decisions[effect.name].reason} (plan: {effect.name} off)"
        for effect in EFFECTS
        for topic in (() if plan.spec.has(effect.name) else effect.channels or ())
    }
    return PlanInLog(metadata, absent)


def metadata_of(job: CellJob, in_log: PlanInLog) -> dict[str, dict[str, str]]:
    """Return the log's metadata about the engine that made it."""
    spec = job.plan.spec
    engine = {"source": source_hash(), "plan": spec.digest(), "solver": spec.solver}
    engine["seed"] = job.seeds
    return {"versions": versions(), "engine": engine, **in_log.metadata}


def divergence(scene: Scene, engine: Engine) -> str:
    """Return one sentence naming the body, the step and the time of the divergence."""
    counters = engine.counters[0]
    step = int(counters["step"])
    name = scene.names[int(counters["body"])]
    cause, time = int(counters["cause"]), float(scene.clock.time(step))
    what = CAUSES.get(cause, "")
    if cause == INACCURATE:
        missed, params = engine.state.control.record[0], engine.parameters[0]
        what = NO_SUBSTEP.format(
            accuracy=params["accuracy"],
            length=missed["length"],
            error=missed["error"],
            bound=(
                f"its step has had {MOST_SUBSTEPS} substeps"
                if int(counters["substeps"]) >= MOST_SUBSTEPS
                else f"none may be shorter than {params['smallest_timestep']:g} s"
            ),
        )
        time += float(missed["start"])
    return f"diverged: body {name} {what} after step {step} (t = {time:.9g} s)"


def interrupted(clock: Clock, signal: str, step: int) -> str:
    """Return one sentence naming the signal, the step and the time."""
    time = float(clock.time(step))
    return f"{INTERRUPTED} by {signal} after step {step} (t = {time:.9g} s)"


def started(scene: Scene, plan: Plan, steps: int) -> tuple[Engine, int]:
    """Return the engine of a scene at its initial state, and what its kernel took [ns].

    steps: of the run.
    """
    start = perf_counter_ns()
    engine = scene.engine(plan.spec, block_steps(steps, len(scene.names)))
    engine.threads = threads_asked()
    engine.advance(0)  # compiles or loads the kernel, and records the initial state
    return engine, perf_counter_ns() - start


def compile_kernel(job: CellJob) -> int:
    """Leave the kernel of a cell where other processes find it; returns what it took [ns]."""
    return started(build(job.config, job.plan.spec), job.plan, 0)[1]


def run_and_measure(jobs: Sequence[CellJob], began: Began | None = None) -> list[EndedCell]:
    """Simulate cells, write their logs, and measure each for the cells of the sweep that it is of.

    Several are short: of one, a stage takes the processor less time than to fetch the code of that
    stage into its caches, so each stage is done for all before the next; those of one plan advance
    in one call of a kernel. What ended is noted in the directory of the run. began: called when the
    kernel of the first is there.
    """
    keep_freed_memory()
    if len(jobs) == 1:  # it may be long
        return _run_and_measure(jobs, began)
    with uncollected():  # of short cells next to nothing is in circles
        return _run_and_measure(jobs, began)


def _run_and_measure(jobs: Sequence[CellJob], began: Began | None) -> list[EndedCell]:
    simulated = _simulate(jobs, began, lambda job, outcome: note_closed(job.path, outcome))
    raise_noted()
    ended = []
    for job, one in zip(jobs, simulated, strict=True):
        ended.append(_measured(job, one))
        note_measured(job.path, ended[-1])
    return ended


def measured_run(job: CellJob) -> EndedCell:
    """Simulate one cell, write its log, and measure it; nothing is noted."""
    return _measured(job, simulate(job))


def measured_later(job: CellJob, outcome: CellOutcome) -> EndedCell:
    """Measure a cell whose log was closed by a process that ended before it was measured."""
    measured = {}
    for cell in _cells_of(job, outcome, open_trace(job.path)):
        always = outcomes_of(job.always, cell) if job.always is not None else {}
        measured[cell.index] = measure_cell(cell, job.measures, None)._replace(always=always)
    note_measured(job.path, EndedCell(outcome, measured))
    return EndedCell(outcome, measured)


def _measured(job: CellJob, simulated: Simulated) -> EndedCell:
    outcome, written, worst = simulated
    cells = _cells_of(job, outcome, trace_of(written))
    return EndedCell(
        outcome, {cell.index: measure_cell(cell, job.measures, worst) for cell in cells}
    )


def _cells_of(job: CellJob, outcome: CellOutcome, trace: Trace) -> list[RunCell]:
    """Return the cells of the sweep that a log is of."""
    place = job.path.parent, job.path.name
    return [
        RunCell(index, label, coordinates, *place, outcome.status, job.config, [trace])
        for index, label, coordinates in job.cells
    ]


def failed(job: CellJob, how: str) -> EndedCell:
    """Return the end of a cell whose process died each time: nothing is measured of it."""
    status = f"failed: its process {how}, both times"
    accuracy = Accuracy(tolerance=job.config.numerics.tolerance)
    why = failure("a complete run", status)
    always = dict.fromkeys(checks_of(job.always), why)
    measured = {
        index: Measured(
            {name: status for name, spec in job.measures.items() if applies(spec, coordinates)},
            always,
        )
        for index, _, coordinates in job.cells
    }
    return EndedCell(CellOutcome(job.cell, status, 0, 0, 0, 0, accuracy), measured)


class Simulated(NamedTuple):
    """A cell that was simulated."""

    outcome: CellOutcome
    written: Written  # its log, as this process may read it
    worst: WorstStates | None  # its states, by `always`


def simulate(job: CellJob, began: Began | None = None) -> Simulated:
    """Simulate one cell and write its log.

    began: called when its kernel is there, with what reads how many steps are done, at any time.
    """
    return _simulate([job], began)[0]


def _simulate(
    jobs: Sequence[CellJob],
    began: Began | None,
    closed: Callable[[CellJob, CellOutcome], None] = lambda job, outcome: None,
) -> list[Simulated]:
    """Simulate cells together; closed: called when a log is. One of another engine is alone."""
    if jobs[0].config.engine is not None:
        from .other_engine import simulate_elsewhere  # late: most cells have no other

        [job] = jobs
        one = Simulated(*simulate_elsewhere(job, began))
        closed(job, one.outcome)
        return [one]
    scenes = [build(job.config, job.plan.spec) for job in jobs]
    ready = [
        started(scene, job.plan, job.config.steps) for job, scene in zip(jobs, scenes, strict=True)
    ]
    if began is not None:
        counters = ready[0][0].counters
        began(lambda: int(counters["step"][0]))

    def noted(job: CellJob, stages: Stages) -> Stages:
        one, more = yield from with_growth(stages, compiled_ns)  # of kernels that lay out the log
        compiling = one.outcome.compile_ns + more
        one = one._replace(outcome=one.outcome._replace(compile_ns=compiling))
        closed(job, one.outcome)
        return one

    with deferred() as signalled:
        return in_turns(
            [
                noted(job, _simulation(job, scene, engine, signalled))
                for job, scene, engine in zip(jobs, scenes, ready, strict=True)
            ],
            _advance,
        )


class _StepsAsked(NamedTuple):
    """Steps that an engine is to do."""

    engine: Engine
    steps: int


Stages = Generator[_StepsAsked | None, EngineAdvance | None, Simulated]


def _advance(calls: Sequence[_StepsAsked]) -> list[EngineAdvance]:
    """Let engines advance together; those that time leaves out ask again, after their signals."""
    engines, steps = zip(*calls, strict=True)
    return advance_together(engines, steps, within=int(CALL * 1e9))


def _simulation(
    job: CellJob, scene: Scene, ready: tuple[Engine, int], signalled: Callable[[], str]
) -> Stages:
    """Simulate one cell and write its log, in stages; steps are done by whoever takes them.

    ready: its engine, and what its kernel took [ns]. signalled: names a signal that came.
    """
    physics_ns = logging_ns = done = stop = 0
    (engine, compile_ns), steps = ready, job.config.steps
    in_log = job.in_log or plan_in_log(job.plan)
    absent, metadata = in_log.absent, metadata_of(job, in_log)
    writer = TraceWriter(job.path, job.config, job.as_written, metadata, absent, job.copy)
    yield None
    # A check finds in a run what it finds in its log.
    unseen = absent | partly_recorded(described(job.config.record))
    bounds = Bounds(job.always, scene.names, job.config, scene.clock, unseen)
    events = EventQueue(engine, scene, job.config.events, job.config.triggered)
    dump = ProblemDump(job.path, job.config.record)
    accuracy = Accuracy(tolerance=job.config.numerics.tolerance)
    status = "complete"
    call = CallLength(len(scene.names))
    while True:
        yield None
        events.apply_due(done)
        result, spent = RUNNING, 0
        if done < steps:
            stop = dump.next_stop(done, events.next_stop(min(steps, done + call.steps)))
            advanced = yield _StepsAsked(engine, stop - done)
            assert advanced is not None
            result, spent = advanced
        made, done = -done, int(engine.counters["step"][0])
        call.after(made + done, spent * 1e-9)
        if result == DIVERGED:
            status = divergence(scene, engine)
        yield None
        start = clock_without_compiling()
        rows = engine.take_rows(room=True)
        if (taken := len(rows.step) - 1) > 0:
            block = block_of(rows, scene.clock)
            block, broken = bounds.within(block, result == DIVERGED, room=True)
            if broken:
                spent = spent * len(block.step) // taken
                last = int(block.step["step"][-1])
                if last < done or result != DIVERGED:
                    result, status, done = STOPPED, broken, last
            logging_ns += clock_without_compiling() - start
            yield None
            start = clock_without_compiling()
            writer.append(block)
            accuracy = accuracy.after(block.step, block.contact, scene.names)
        dump.take(engine, done, stop)
        physics_ns += spent
        logging_ns += clock_without_compiling() - start
        if result in (DIVERGED, STOPPED) or (result == RUNNING and done >= steps):
            break
        if name := signalled():
            status = interrupted(scene.clock, name, done)
            break
    yield None
    start = clock_without_compiling()
    written = writer.close(status)
    logging_ns += clock_without_compiling() - start
    times = compile_ns, physics_ns, logging_ns
    outcome = CellOutcome(job.cell, status, done, *times, accuracy, written.digest)
    return Simulated(outcome, written, bounds.worst)
