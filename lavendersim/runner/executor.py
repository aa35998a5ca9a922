"""Runs cells in this process or in a pool of them, and compiles several plans at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import inf
from pathlib import Path
from time import perf_counter, process_time
from typing import Any, Final, NamedTuple

from lavendersim.engine.compile import compiler_is_off
from lavendersim.engine.kernel_store import directory
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import is_compiled, uncompiled
from lavendersim.engine.together import advance_engines, is_possible
from lavendersim.errors import UsageError

from .cell import CellJob, compile_kernel, failed, run_and_measure
from .cell_outcome import CellOutcome, EndedCell
from .forking import may_fork
from .progress import Compilation, Progress, Tally
from .workers import Death, Retried, work

# Cells that would take the processor less [s] than this one after the other are run in this
# process: each other one imports numba and loads kernels for 1 to 2 s before its first step.
WORTH_PROCESSES = 4.0
# Of it. A process that is forked takes 0.02 to 0.05 s to begin and to end: two save no more than
# twice that where a core has nothing to do, and where none has they take that longer.
FORKED: Final = 0.125
# Cells are short whose steps and bodies make no more than this, where the one before them took no
# more than BRIEF [s] of the processor. They are run together, so many at once: what a signal waits
# for, and what a kill takes, is less than a second of work.
SHORT: Final = 8000
BRIEF: Final = 0.03
TOGETHER: Final = 16
BATCHES: Final = 8  # of them at least for each process, so that all end at one time


def outcomes_of(
    jobs: Sequence[CellJob], workers: int, progress: Progress
) -> Iterator[tuple[CellJob, EndedCell]]:
    """Run and measure every job; with several workers they do not come in the order of `jobs`."""
    if compiler_is_off():
        raise UsageError("NUMBA_DISABLE_JIT is set: lavender runs compiled kernels only, unset it")
    if not jobs:
        return
    first: dict[tuple[Any, ...], CellJob] = {}
    for job in jobs:
        if job.config.engine is None:  # what runs elsewhere has no kernel
            first.setdefault(job.plan.choices, job)
    missing = _missing(list(first.values()))
    tally = Tally(jobs)
    progress.running(tally)
    apart = _compile_together(missing, workers, progress)
    # The first cell of each plan runs here: it leaves the kernel where other processes find it.
    ordered = sorted(jobs, key=lambda job: first.get(job.plan.choices) is not job)
    # Cells that are done, what those took that were no first ones, and each of the last ones [s].
    done, taken, latest = 0, 0.0, inf
    worth = WORTH_PROCESSES * (FORKED if may_fork() else 1.0)
    while done < len(ordered):
        left = len(ordered) - done
        job = ordered[done]
        # The first cell of a plan loads what all others have: another tells whether they are brief,
        # where they may be enough for batches.
        is_known = done > len(first) or not _is_short(job) or left - 1 < 2 * BATCHES * workers
        each = taken / (done - len(first)) if done > len(first) else latest
        if workers > 1 and done and done >= len(first) and is_known and each * left > worth:
            break
        most = TOGETHER if done > len(first) and latest <= BRIEF else 1
        batch = next(_batches(ordered[done : done + most], most))
        _load_call(batch)
        begun = missing.get(job.plan.spec) if done < len(first) else None
        if begun is not None and is_compiled(job.plan.spec):  # by a cell before, or beside
            begun = None
        clock = _clock_of(job)
        begin = clock()
        ended = run_and_measure(batch, _beginning(job, begun, tally, progress))
        spent = _without_compiling(clock() - begin, [one.outcome for one in ended])
        latest = spent / len(batch)
        taken += spent if done >= len(first) else 0.0
        done += len(batch)
        for job, one in zip(batch, ended, strict=True):
            tally.end(job)
            compiling = one.outcome.compile_ns + apart.pop(job.path, 0)
            yield job, one._replace(outcome=one.outcome._replace(compile_ns=compiling))
    rest = [job.alone() for job in ordered[done:]]
    if not rest:
        return
    tally.begin_in_others()
    most = len(rest) // (BATCHES * workers) if done > len(first) and latest <= BRIEF else 1
    batches = [*_batches(rest, most)]
    _load_call(max(batches, key=len))
    for job, found in _run_in_others(batches, workers, progress):
        tally.end(job)
        yield job, failed(job, found.how) if isinstance(found, Death) else found


def _without_compiling(took: float, outcomes: Sequence[CellOutcome]) -> float:
    """Return what cells took [s] without their kernels.

    Theirs is a time of the clock: where others have the cores it may be more than all that the
    processor did here. What was simulated took it something.
    """
    compiling = sum(one.compile_ns for one in outcomes) / 1e9
    simulating = sum(one.physics_ns + one.logging_ns for one in outcomes) / 1e9
    return max(took - compiling, min(took, simulating))


def _clock_of(job: CellJob) -> Callable[[], float]:
    """Return what tells the time that a cell takes [s].

    That of the processor: a busy one is slower, and there is less to gain by other processes. But
    another engine works in a process of its own, whose time is not counted in this one.
    """
    return process_time if job.config.engine is None else perf_counter


def _batches(jobs: Sequence[CellJob], most: int) -> Iterator[list[CellJob]]:
    """Yield the jobs in their order, short ones that follow each other together."""
    at = 0
    while at < len(jobs):
        end = min(at + max(min(most, TOGETHER), 1), len(jobs))
        long = next((place for place in range(at, end) if not _is_short(jobs[place])), end)
        batch = jobs[at : max(long, at + 1)]
        at += len(batch)
        yield [*batch]


def _load_call(batch: Sequence[CellJob]) -> None:
    """Have the kernel that several engines advance by, before times are taken or processes made."""
    if len(batch) > 1 and is_possible():
        advance_engines()


def _is_short(job: CellJob) -> bool:
    config = job.config
    if config.engine is not None or config.numerics.accuracy is not None:
        return False  # what their steps take is not known
    if (config.record.residuals, config.record.problems) != ("none", "none"):
        return False  # their logs are large
    steps = float(config.duration) / float(config.numerics.timestep)
    return steps * len(config.scene.bodies) <= SHORT


def _run_in_others(
    batches: Sequence[list[CellJob]], workers: int, progress: Progress
) -> Iterator[tuple[CellJob, EndedCell | Death]]:
    """Run batches in other processes. Of one that they die of, each cell is run by itself."""
    alone: list[list[CellJob]] = []
    for batch, found in work(run_and_measure, batches, workers, partial(_run_again, progress)):
        if not isinstance(found, Death):
            yield from zip(batch, found, strict=True)
            continue
        died = f"the process of {_named(batch)} {found.how} again"
        if len(batch) == 1:
            progress.warning(f"{died}; the cell is given up")
            yield batch[0], found
        else:
            progress.warning(f"{died}; each is run by itself")
            alone += [[job] for job in batch]
    if alone:
        yield from _run_in_others(alone, workers, progress)


def _run_again(progress: Progress, one: Retried[list[CellJob]]) -> None:
    count = len(one.task)
    again = "the cell is" if count == 1 else f"these {count} cells are"
    progress.warning(f"the process of {_named(one.task)} {one.death.how}; {again} run once more")


def _named(batch: Sequence[CellJob]) -> str:
    names = [str((job.cells[0].label if job.cells else "") or job.cell) for job in batch]
    return f"cell {names[0]}" if len(names) == 1 else f"cells {names[0]} to {names[-1]}"


class _Missing(NamedTuple):
    job: CellJob
    compilation: Compilation


def _missing(first: list[CellJob]) -> dict[Spec, _Missing]:
    """Return each kernel that is to be compiled, once, with the first cell that needs it."""
    specs = uncompiled(job.plan.spec for job in first)
    if not specs:
        return {}
    from lavendersim.scene.explanation import title_of  # late: only what compiles needs a title

    plans = [job.plan for job in first]
    jobs = {job.plan.spec: job for job in reversed(first)}  # the first of each
    return {
        spec: _Missing(
            jobs[spec],
            Compilation(jobs[spec].plan, title_of(jobs[spec].plan, plans), number, len(specs)),
        )
        for number, spec in enumerate(specs, start=1)
    }


def _beginning(
    job: CellJob, missing: _Missing | None, tally: Tally, progress: Progress
) -> Callable[[Callable[[], int]], None]:
    """Announce what a cell compiles; returns what is to be called when its kernel is there."""
    if missing is not None:
        progress.compiling(missing.compilation)

    def began(steps_done: Callable[[], int]) -> None:
        if missing is not None:
            progress.compiled(missing.compilation)
        tally.begin(job, steps_done)

    return began


def _compile_together(
    missing: dict[Spec, _Missing], workers: int, progress: Progress
) -> dict[Path, int]:
    """Compile several plans at once, each in a process of its own; returns the time [ns] by log.

    Where one plan is missing, or one process asked for, or no kernel can be kept, nothing is done.
    """
    if min(workers, len(missing)) < 2 or not directory()[0].name:
        return {}
    times: dict[Path, int] = {}
    for one in missing.values():
        progress.compiling(one.compilation)
    compilations = {one.job.path: one.compilation for one in missing.values()}
    for job, spent in work(compile_kernel, [one.job for one in missing.values()], workers):
        if not isinstance(spent, Death):  # else its cell compiles it
            times[job.path] = spent
        progress.compiled(compilations[job.path])
    return times
