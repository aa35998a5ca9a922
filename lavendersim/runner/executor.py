"""Jobs enter, each with its outcome leaves, from this process or from a pool of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

from lavendersim.engine.step import advance_for, is_compiled
from lavendersim.scene.plan import Plan

from .cell import CellJob, CellOutcome, run_cell


def outcomes_of(
    jobs: Sequence[CellJob], workers: int, compiling: Callable[[Plan], None]
) -> Iterator[tuple[CellJob, CellOutcome]]:
    """Run every job; with several workers they do not come in the order of `jobs`.

    compiling: called before a kernel is compiled, once for each plan that has none yet.
    """
    first: dict[tuple[Any, ...], CellJob] = {}
    for job in jobs:
        first.setdefault(job.plan.choices, job)
    # The first cell of each plan runs here: it leaves the kernel where other processes find it.
    here = jobs if workers <= 1 else list(first.values())
    for job in here:
        if first[job.plan.choices] is job:
            advance_for(job.plan.spec)
            if not is_compiled(job.plan.spec):
                compiling(job.plan)
        yield job, run_cell(job)
    rest = [] if workers <= 1 else [job for job in jobs if first[job.plan.choices] is not job]
    if not rest:
        return
    # Spawned, never forked: numba's threads do not survive a fork.
    with ProcessPoolExecutor(min(workers, len(rest)), get_context("spawn")) as pool:
        chunk = max(1, len(rest) // (4 * workers))
        yield from zip(rest, pool.map(run_cell, rest, chunksize=chunk), strict=True)
