"""Workers of Dask: at an address, of a cluster's queue, or processes of this machine.

Alone knows dask, an extra. What a queue takes stands where dask-jobqueue and Dask look for it
(`~/.config/dask/*.yaml`); lavender's part of it says which queue, and how many jobs:

    lavender:
      queue: slurm     # slurm, pbs, lsf or sge; its limits: jobqueue.slurm
      jobs: 20
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any, Final

from lavendersim.errors import UsageError

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
    import dask

    queue = dask.config.get("lavender.queue", None)
    if queue is None:
        from distributed import LocalCluster

        return LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None)
    if queue not in QUEUES:
        expected = ", ".join(QUEUES)
        raise UsageError(f"lavender.queue: {queue!r} in Dask's configuration, expected {expected}")
    if find_spec("dask_jobqueue") is None:
        raise UsageError(f"queue {queue}: needs dask-jobqueue: pip install lavendersim[dask]")
    import dask_jobqueue

    cluster = getattr(dask_jobqueue, QUEUES[queue])()
    cluster.scale(jobs=dask.config.get("lavender.jobs", 1))
    return cluster
