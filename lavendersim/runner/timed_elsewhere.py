"""What the steps of another engine cost, sample by sample, as `timed_engine` tells of lavender's.

Each sample is asked of the process that times its engine; all settings of an engine share one.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import nan

from lavendersim.cell import CellConfig
from lavendersim.peers.catalogue import peer_of
from lavendersim.peers.messages import Task
from lavendersim.peers.timing import EngineFailed, TimingServer, TimingTask

Servers = dict[str, TimingServer]  # by engine


@contextmanager
def timing_servers() -> Iterator[Servers]:
    """Give the processes that time other engines, to be filled; all are ended afterwards."""
    servers: Servers = {}
    try:
        yield servers
    finally:
        for server in servers.values():
            server.close()


class TimedElsewhere:
    """The same steps of a cell by its engine, again and again."""

    def __init__(
        self, config: CellConfig, first: int, steps: int, shortest: int, servers: Servers
    ) -> None:
        """Take the steps after `first`; shortest: a sample repeats them for so long [ns]."""
        assert config.engine is not None
        self.steps = steps
        task = Task(config.as_json(), config.engine.name, dict(config.engine.settings))
        self._asked = TimingTask(task, first, steps, shortest)
        self._server = servers.setdefault(peer_of(config.engine.name).name, TimingServer())

    def sample(self) -> float:
        """Return the cost of a step [ns]; NaN where the engine gave none."""
        try:
            return self._server.sample(self._asked)
        except EngineFailed:
            return nan
