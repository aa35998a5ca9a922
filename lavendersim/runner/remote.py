"""Cells run by somebody else's workers, through the interface of `concurrent.futures`.

    a cell as plain data -> a worker -> how it ended, what was measured, its log
                                        log: in the run's directory where the worker sees that,
                                        in the result where it does not

The index and the notes of what ended are written by this process alone: many machines cannot append
to one file of a file server. A worker writes a log under a name of its own and renames it when it
is whole, so two that were given one cell are not in each other's way; their bytes are the same.
"""

from __future__ import annotations

import os
import tempfile
import uuid
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from pathlib import Path
from time import sleep
from typing import Final, NamedTuple

from lavendersim.durable_files import write_whole
from lavendersim.errors import LavenderError, UsageError

from .cell import CellJob, failed, measured_run
from .cell_outcome import EndedCell, note_measured
from .progress import Progress, Tally

AHEAD: Final = 256  # cells that workers are given before one of them has ended
TRIES: Final = 2  # of a cell whose worker was lost
RESTARTS: Final = 5  # of a scheduler
SETTLED: Final = 2.0  # [s] after which a client has noticed that its scheduler is gone


class RemoteTask(NamedTuple):
    """A cell as a worker is given it."""

    job: CellJob
    sign: str  # name and content of a file beside the logs: who sees it, shares the folder


class RemoteResult(NamedTuple):
    """What comes back."""

    ended: EndedCell
    log: bytes | None  # None: it is in its place


def run_by(
    executor: Executor, jobs: Sequence[CellJob], progress: Progress
) -> Iterator[tuple[CellJob, EndedCell]]:
    """Run and measure every job by an executor; they do not come in the order of `jobs`.

    A cell whose worker was lost is run once more; where it is lost again, it has failed.
    UsageError where the executor takes no more work.
    """
    if not jobs:
        return
    tally = Tally(jobs)
    progress.running(tally)
    tally.begin_in_others()
    alone = [job.alone() for job in jobs]
    with _signed(jobs[0].path.parent) as sign:
        for job, found in _results(executor, alone, sign, progress.warning):
            tally.end(job)
            if isinstance(found, str):
                yield job, failed(job, found)
                continue
            if found.log is not None:
                write_whole(job.path, found.log, flush=False)
            note_measured(job.path, found.ended)
            yield job, found.ended


def run_there(task: RemoteTask) -> RemoteResult:
    """Run one cell, on the worker."""
    job = task.job
    sign = job.path.parent / task.sign
    if _text(sign) == task.sign:
        log = job.path.with_name(f".{job.path.name}.{uuid.uuid4().hex}.unfinished")
        try:
            ended = measured_run(job._replace(path=log))
            os.replace(log, job.path)
        finally:
            log.unlink(missing_ok=True)
        return RemoteResult(ended, None)
    with tempfile.TemporaryDirectory(prefix="lavender-") as folder:
        log = Path(folder) / job.path.name
        ended = measured_run(job._replace(path=log))
        return RemoteResult(ended, log.read_bytes())


def _results(
    executor: Executor,
    jobs: Sequence[CellJob],
    sign: str,
    warning: Callable[[str], None],
) -> Iterator[tuple[CellJob, RemoteResult | str]]:
    """Yield every job with what came back, or how its worker was lost both times."""
    waiting = [(job, 1) for job in reversed(jobs)]
    running: dict[Future[RemoteResult], tuple[CellJob, int]] = {}
    restarts = 0
    try:
        while waiting or running:
            while waiting and len(running) < AHEAD:
                job, number = waiting.pop()
                running[_submit(executor, RemoteTask(job, sign))] = job, number
            ended = wait(running, return_when=FIRST_COMPLETED).done
            if any(future.cancelled() for future in ended):
                # Nobody here cancels: a scheduler was lost, and with it all it was given. What is
                # given to its client before that has noticed is lost, too, and results that were on
                # their way never come.
                restarts += 1
                if restarts > RESTARTS:
                    raise UsageError(f"the executor lost its scheduler {restarts} times")
                sleep(SETTLED)
                left = [one for future, one in running.items() if not _has_result(future)]
                ended = {future for future in running if _has_result(future)}
                running = {future: running[future] for future in ended}
                waiting += left
                warning(f"the executor lost its scheduler; {len(left)} cells are given to it again")
            for future in ended:
                job, number = running.pop(future)
                lost = _lost(future)
                if lost is None:
                    yield job, future.result()
                elif number < TRIES:
                    name = job.cells[0].label or job.cell
                    warning(f"the worker of cell {name} {lost}; the cell is run once more")
                    waiting.append((job, number + 1))
                else:
                    name = job.cells[0].label or job.cell
                    warning(f"the worker of cell {name} {lost} again; the cell is given up")
                    yield job, lost
    finally:
        for future in running:
            future.cancel()


def _submit(executor: Executor, task: RemoteTask) -> Future[RemoteResult]:
    try:
        return executor.submit(run_there, task)
    except Exception as error:  # each library has errors of its own
        raise UsageError(f"the executor takes no more cells: {error}") from error


def _has_result(future: Future[RemoteResult]) -> bool:
    return future.done() and not future.cancelled()


def _lost(future: Future[RemoteResult]) -> str | None:
    """Say how the worker of a cell was lost; None where there is a result.

    What is wrong with the cell, or with the disk, is raised.
    """
    error = future.exception()
    if isinstance(error, LavenderError | OSError):
        raise error
    return f"was lost ({type(error).__name__})" if error is not None else None


@contextmanager
def _signed(folder: Path) -> Iterator[str]:
    """Put a sign into a folder meanwhile that no other folder has; what lost workers left goes."""
    sign = f".{uuid.uuid4().hex}.sign"
    write_whole(folder / sign, sign, flush=False)
    try:
        yield sign
    finally:
        for left in (folder / sign, *folder.glob(".*.unfinished")):
            left.unlink(missing_ok=True)


def _text(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:
        return ""
