"""What the steps of an engine cost: a process an engine, which gives a sample whenever it is asked.

    runner -- TimingTask --> server -- fork --> builds, steps, times; builds again, ...
           <-- ns a step --                     and ends

    python -m lavendersim.peers.timing FD

Every sample is a fresh copy of a process that has loaded the engine and stepped nothing: no sample
inherits the state of another, and one that crashes takes itself alone away. Time is that of the
steps alone, by the processor, of all threads that the engine may have in spite of its settings.
Building and the first pass, which warms the caches, are outside.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from importlib import import_module
from math import ceil
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter_ns, process_time_ns
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.peers.catalogue import peer_of
from lavendersim.peers.description import Scene
from lavendersim.peers.messages import Task
from lavendersim.peers.process import SILENCE, start

MODULE: Final = "lavendersim.peers.timing"
LONGEST_NS: Final = 200_000_000  # of a sample, building included; engines build in up to 0.1 s


class TimingTask(NamedTuple):
    """Steps to be timed, once."""

    task: Task
    first: int  # steps made before
    steps: int
    shortest: int  # [ns] the steps are made again and again for so long


class EngineFailed(Exception):  # noqa: N818 - what an engine does is a result
    """A sample that an engine did not give; the message says why."""


class TimingServer:
    """The process that times one engine, from outside; it is started when first asked."""

    def __init__(self, silence: float = SILENCE, module: str = MODULE) -> None:
        """Take the [s] without an answer after which the process is ended."""
        self._silence, self._module = silence, module
        self._process: subprocess.Popen[bytes] | None = None
        self._pipe: Connection | None = None

    def sample(self, asked: TimingTask) -> float:
        """Return the cost of a step [ns], the median over passes; raises EngineFailed."""
        if self._process is None:
            self._start()
        assert self._pipe is not None
        try:
            self._pipe.send(asked)
            if not self._pipe.poll(self._silence):
                self.close()
                raise EngineFailed(f"hangs: no sample came in {self._silence:g} s")
            answer: Any = self._pipe.recv()
        except (EOFError, OSError):
            self.close()
            raise EngineFailed("crashed: the process that times it has ended") from None
        if isinstance(answer, str):
            raise EngineFailed(answer)
        return float(answer)

    def _start(self) -> None:
        here, there = Pipe()
        self._folder = TemporaryDirectory()
        nothing = subprocess.DEVNULL
        self._process = start(self._module, there.fileno(), self._folder.name, nothing, nothing)
        there.close()
        self._pipe = here

    def close(self) -> None:
        """End the process and its copies."""
        if self._process is None or self._pipe is None:
            return
        self._pipe.close()
        with suppress(ProcessLookupError):  # it has ended
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._folder.cleanup()
        self._process = self._pipe = None


def sample_of(asked: TimingTask) -> float:
    """Return the cost of a step [ns] in this process, the median over passes."""
    engine, settings = asked.task.engine, asked.task.settings
    scene = Scene(CellConfig.from_dict(json.loads(asked.task.config)))
    make = import_module(f"lavendersim.peers.adapters.{peer_of(engine).name}").World

    def once() -> int:
        world = make(scene, settings)
        _advance(world, scene, 0, asked.first)
        return _advance(world, scene, asked.first, asked.steps)

    begin = perf_counter_ns()
    passes = ceil(asked.shortest / max(1, once()))
    affordable = LONGEST_NS // max(1, perf_counter_ns() - begin)
    return median(once() for _ in range(max(1, min(passes, affordable)))) / asked.steps


def _advance(world: Any, scene: Scene, first: int, steps: int) -> int:
    """Make steps and return the time [ns] that they alone took."""
    step = world.step
    if not scene.has_forces:
        begin = process_time_ns()
        for _ in range(steps):
            step()
        return process_time_ns() - begin
    spent, nothing = 0, np.zeros((len(scene.movable), 6))
    for number in range(first + 1, first + steps + 1):
        loads = scene.loads(number)
        world.push(nothing if loads is None else loads)
        begin = process_time_ns()
        step()
        spent += process_time_ns() - begin
    return spent


def _answer(asked: TimingTask, pipe: Connection) -> None:
    """Send a sample, or why there is none."""
    try:
        pipe.send(sample_of(asked))
    except Exception as error:  # whatever an engine raises is its result
        pipe.send(f"{type(error).__name__}: {' '.join(str(error).split())}")


def main() -> None:
    """Answer until nobody asks any more."""
    with Connection(int(sys.argv[1])) as pipe:
        while True:
            try:
                asked = pipe.recv()
            except EOFError:
                return
            import_module(f"lavendersim.peers.adapters.{peer_of(asked.task.engine).name}")
            copy = os.fork()
            if copy == 0:
                _answer(asked, pipe)
                os._exit(0)
            code = os.waitstatus_to_exitcode(os.waitpid(copy, 0)[1])
            if code:
                ended = f"was ended by {signal.Signals(-code).name}" if code < 0 else ""
                pipe.send(f"crashed: its process {ended or f'exited with {code}'}")


if __name__ == "__main__":
    main()
