"""What processes of the tests are given to do; some of it kills them."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any, NamedTuple


class Task(NamedTuple):
    """A number to be squared."""

    number: int
    notes: Path  # a folder
    deaths: int = 0  # how often a process dies of it
    how: int = signal.SIGKILL


def squared(task: Task) -> int:
    """Return the square of a number, unless this process is to die of it."""
    mine = len(list(task.notes.glob(f"{task.number}-*")))
    (task.notes / f"{task.number}-{mine}").touch()
    if mine < task.deaths:
        os.kill(os.getpid(), task.how)
        time.sleep(60.0)
    if task.number < 0:
        raise ValueError(f"{task.number} is negative")
    return task.number**2


def meets(task: Task) -> int:
    """Return when all of three tasks have begun: there is a process for each."""
    (task.notes / str(task.number)).touch()
    until = time.monotonic() + 60.0
    while len(list(task.notes.iterdir())) < 3:
        if time.monotonic() > until:
            raise TimeoutError("another task waits behind this one")
        time.sleep(0.01)
    return task.number


def exits(task: int) -> int:
    """End the process as no process should."""
    os._exit(task)


def dies_at_one_half(jobs: Any, *began: Any) -> Any:
    """Run cells, but die with that of e = 0.5 every time."""
    for job in jobs:
        if job.cells[0].label == "e=0.5":
            job.path.write_bytes(b"begun")
            os.kill(os.getpid(), signal.SIGKILL)
    from lavendersim.runner.cell import run_and_measure  # late: a second, in a process of numbers

    return run_and_measure(jobs, *began)


def dies_once_at_one_half(jobs: Any, *began: Any) -> Any:
    """Run cells, but die with that of e = 0.5 the first time."""
    from lavendersim.runner.cell import run_and_measure

    if any(job.path.exists() for job in jobs):
        return run_and_measure(jobs, *began)
    return dies_at_one_half(jobs, *began)
