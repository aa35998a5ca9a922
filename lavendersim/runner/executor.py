"""Runs cells in this process or in a pool of them, and compiles several plans at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any

from lavendersim.engine.compile import compiler_is_off
from lavendersim.engine.kernel_cache import directory
from lavendersim.engine.step import is_compiled
from lavendersim.errors import UsageError
from lavendersim.scene.plan import Plan

from .cell import CellJob, CellOutcome, compile_kernel, run_and_measure
from .measured import Measured

# Cells that would take less [s] than this one after the other are run in this process: each other
# process imports numba and loads kernels for 1 to 2 s of processor time before its first step.
WORTH_PROCESSES = 4.0


def outcomes_of(
    jobs: Sequence[CellJob], workers: int, compiling: Callable[[Plan], None]
) -> Iterator[tuple[CellJob, CellOutcome, dict[int, Measured]]]:
    """Run and measure every job; with several workers they do not come in the order of `jobs`.

    compiling: called before a kernel is compiled, once for each plan that has none yet. Yielded
    are the job, how it ended, and what was measured, by the cells of the sweep.
    """
    if compiler_is_off():
        raise UsageError("NUMBA_DISABLE_JIT is set: lavender runs compiled kernels only, unset it")
    first: dict[tuple[Any, ...], CellJob] = {}
    for job in jobs:
        first.setdefault(job.plan.choices, job)
    apart = _compile_together(list(first.values()), workers, compiling)
    # The first cell of each plan runs here: it leaves the kernel where other processes find it.
    ordered = sorted(jobs, key=lambda job: first[job.plan.choices] is not job)
    done, taken = 0, 0.0  # and what they took [s]
    while done < len(ordered):
        rest = ordered[done:]
        if workers > 1 and done >= len(first) and taken / done * len(rest) > WORTH_PROCESSES:
            break
        job = rest[0]
        if done < len(first) and not is_compiled(job.plan.spec):
            compiling(job.plan)
        begin = perf_counter()
        outcome, measured = run_and_measure(job)
        done, taken = done + 1, taken + perf_counter() - begin - outcome.compile_ns / 1e9
        spent = outcome.compile_ns + apart.pop(job.path, 0)
        yield job, outcome._replace(compile_ns=spent), measured
    rest = ordered[done:]
    if not rest:
        return
    with _pool(workers, len(rest)) as pool:
        chunk = max(1, len(rest) // (4 * workers))
        found = pool.map(run_and_measure, rest, chunksize=chunk)
        for job, (outcome, measured) in zip(rest, found, strict=True):
            yield job, outcome, measured


def _pool(workers: int, tasks: int) -> ProcessPoolExecutor:
    # Spawned, never forked: numba's threads do not survive a fork.
    return ProcessPoolExecutor(min(workers, tasks), get_context("spawn"))


def _compile_together(
    jobs: list[CellJob], workers: int, compiling: Callable[[Plan], None]
) -> dict[Path, int]:
    """Compile several plans at once, each in a process of its own; returns the time [ns] by log.

    Where one plan is missing, or one process asked for, or no kernel can be kept, nothing is done.
    """
    missing = [job for job in jobs if not is_compiled(job.plan.spec)]
    if min(workers, len(missing)) < 2 or not directory()[0].name:
        return {}
    for job in missing:
        compiling(job.plan)
    with _pool(workers, len(missing)) as pool:
        times = pool.map(compile_kernel, missing)
        return {job.path: spent for job, spent in zip(missing, times, strict=True)}
