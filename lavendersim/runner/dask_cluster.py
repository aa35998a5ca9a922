"""Workers of Dask: at an address, of a cluster's queue, or processes of this machine.

Alone knows dask, an extra. What a queue takes stands where dask-jobqueue and Dask look for it
(`~/.config/dask/*.yaml`); lavender's part of it says which queue, and how many jobs:

    lavender:
      queue: slurm     # slurm, pbs, lsf or sge; its limits: jobqueue.slurm
      jobs: 20
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any, Final, NamedTuple

from lavendersim.errors import UsageError
from lavendersim.quantities.found import found, nearest, quoted

QUEUES: Final = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "lsf": "LSFCluster",
    "sge": "SGECluster",
}
TIMEOUT: Final = "30s"  # for a scheduler to answer
DEATHS: Final = 3  # workers that a cell may lose before it has failed; Dask gives it to others


@contextmanager
def dask_workers(address: str | None, jobs: int) -> Iterator[Executor]:
    """Give an executor whose workers are Dask's, as long as they are needed.

    address: of a scheduler that runs. None: the queue of Dask's configuration, and where it names
    none so many processes of this machine. UsageError where it cannot be had.
    """
    if find_spec("distributed") is None:
        raise UsageError("--executor dask needs Dask: pip install lavendersim[dask]")
    import dask
    from distributed import Client

    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS})
    try:
        cluster = None if address is not None else _cluster(jobs)
        client = Client(address or cluster, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        raise UsageError(f"--dask {address or 'of the configuration'}: {error}") from error
    try:
        yield client.get_executor(pure=False)
    finally:
        client.close()
        if cluster is not None:
            cluster.close()


def _cluster(jobs: int) -> Any:
    """Return the workers that Dask's configuration asks for."""
    asked = asked_of_queue()
    if asked is None:
        from distributed import LocalCluster

        return LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
    if find_spec("dask_jobqueue") is None:
        raise UsageError(f"queue {asked.queue}: needs dask-jobqueue: pip install lavendersim[dask]")
    cluster = getattr(job_queues(), QUEUES[asked.queue])()
    cluster.scale(jobs=asked.jobs)
    return cluster


def job_queues() -> Any:
    """Return dask-jobqueue, whose import takes Ctrl-C: the handler of who imports it stays."""
    before = signal.getsignal(signal.SIGINT)
    try:
        import dask_jobqueue
    finally:
        signal.signal(signal.SIGINT, before)
    return dask_jobqueue


class Queue(NamedTuple):
    """What is asked of a cluster."""

    queue: str  # one of QUEUES
    jobs: int = 1


def asked_of_queue() -> Queue | None:
    """Return what section `lavender` of Dask's configuration asks for; None where it has none.

    UsageError for a key or a value that cannot be.
    """
    import dask

    section = dask.config.get("lavender", None)
    if section is None:
        return None
    where = "section lavender of Dask's configuration"
    if not isinstance(section, dict):
        raise UsageError(f"{where}: expected queue and jobs, found {found(section)}")
    for key in section.keys() - {*Queue._fields}:
        raise UsageError(f"{where}: unknown key {quoted(key)}{nearest(key, Queue._fields)}")
    name, jobs = section.get("queue"), section.get("jobs", 1)
    if name not in [*QUEUES]:
        known = ", ".join(QUEUES)
        raise UsageError(f"{where}: queue: expected one of {known}, found {found(name)}")
    if isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1:
        raise UsageError(f"{where}: jobs: expected a whole number from 1 on, found {found(jobs)}")
    return Queue(name, jobs)
