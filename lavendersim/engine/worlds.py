"""Many worlds in one call: engines of one plan whose arrays have the world as their first axis.

    worlds = Worlds([engine, ...])           each engine's arrays become rows of arrays of all
    statuses = worlds.advance(240, threads=2)
    rows = [engine.take_rows() for engine in engines]

A thread steps a block of worlds by one call of a kernel, without the interpreter lock. It makes the
steps of a world by `advance`, at the address of its rows: bits are those of the engine alone. An
engine stays one, whose steps, rows and events are its own. One that needs more room than the worlds
were given gets arrays of its own, and goes on by itself from then on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from itertools import pairwise
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np

from lavendersim.garbage import uncollected

from .compile import Kernel, compiling, kernel
from .engine import Engine
from .kernel_cache import cached
from .memory import Log, State, Workspace, arrays_of
from .memory_references import memory_at, words_of
from .records import CONTACTS_FULL, PAIRS_FULL, ROWS_FULL, WOKEN
from .spec import Spec
from .step import make_advance

# A world that returns one of these goes on by its engine, which makes room for it.
_UNFINISHED = (CONTACTS_FULL, PAIRS_FULL, ROWS_FULL, WOKEN)


class _WorldMemory(NamedTuple):
    """The memory of one world."""

    state: State
    workspace: Workspace
    log: Log


class _CallOfWorlds(NamedTuple):
    """What a call needs of n worlds beside their memory."""

    parameters: np.ndarray  # (n, 1) records
    counters: np.ndarray  # (n, 1) records
    left: np.ndarray  # (n,) steps to do; -1: the world goes on by itself
    status: np.ndarray  # (n,) what the steps returned


class Worlds:
    """Engines of one plan that advance together. Kernels are compiled for the plan once more."""

    def __init__(self, engines: Sequence[Engine]) -> None:
        """engines: of one spec, with as much room each. ValueError for others, or none."""
        if not engines:
            raise ValueError("no worlds")
        self.engines = tuple(engines)
        memories = [_memory_of(engine) for engine in engines]
        forms = [_form(memory) for memory in memories]
        first = engines[0].spec
        if any(engine.spec != first for engine in engines) or any(one != forms[0] for one in forms):
            raise ValueError("worlds in one call have one plan, and arrays of equal shapes")
        self._memory = _stacked(memories)
        self._views = []
        for number, engine in enumerate(self.engines):
            view = _mapped(self._memory, itemgetter(number))
            engine.state, engine.workspace, engine.log, engine.parameters, engine.counters = view
            engine.note_memory()
            self._views.append(_WorldMemory(engine.state, engine.workspace, engine.log))
        self._places = np.array([words_of(view) for view in self._views])
        self._kernel = _kernel_for(first)
        self._status = np.zeros(len(engines), np.int64)

    def advance(self, steps: int, threads: int = 1) -> list[int]:
        """Do up to so many steps of every world; return what `Engine.advance` returns of each."""
        targets = [int(engine.counters["step"][0]) + steps for engine in self.engines]
        left = np.full(len(self.engines), steps)
        for number, engine in enumerate(self.engines):
            if not self._is_here(number):
                left[number] = -1
                self._status[number] = engine.advance(steps)
        self._call(left, threads)
        for number, engine in enumerate(self.engines):
            if left[number] >= 0 and self._status[number] in _UNFINISHED:
                rest = targets[number] - int(engine.counters["step"][0])
                self._status[number] = engine.advance(rest)
        return [int(status) for status in self._status]

    def _is_here(self, number: int) -> bool:
        """Whether the arrays of a world are still rows of those of all."""
        engine = self.engines[number]
        now = engine.state, engine.workspace, engine.log
        return all(one is other for one, other in zip(now, self._views[number], strict=True))

    def _call(self, left: np.ndarray, threads: int) -> None:
        if Kernel is not None and not self._kernel.overloads:  # compiled by one thread
            with compiling():
                self._step_block(left, (0, 0))
        ends = np.linspace(0, len(left), threads + 1).astype(int).tolist()
        blocks = [*pairwise(ends)]
        if len(blocks) == 1:
            self._step_block(left, blocks[0])
            return
        with ThreadPoolExecutor(len(blocks)) as pool:
            list(pool.map(partial(self._step_block, left), blocks))

    def _step_block(self, left: np.ndarray, block: tuple[int, int]) -> None:
        if Kernel is None:  # memory has no address there
            for number in range(*block):
                if left[number] >= 0:
                    self._status[number] = self.engines[number].advance(int(left[number]))
            return
        _, _, _, parameters, counters = self._memory
        numbers = _CallOfWorlds(parameters, counters, left, self._status)
        self._kernel(self._views[0], self._places, numbers, block)


def _memory_of(engine: Engine) -> tuple[Any, ...]:
    return engine.state, engine.workspace, engine.log, engine.parameters, engine.counters


def _mapped(memory: Any, change: Callable[[np.ndarray], np.ndarray]) -> Any:
    """Return the tuples of an engine's memory with every array changed."""
    if isinstance(memory, np.ndarray):
        return change(memory)
    if isinstance(memory, tuple):
        parts = [_mapped(part, change) for part in memory]
        return type(memory)(*parts) if hasattr(memory, "_fields") else tuple(parts)
    return memory


def _form(memory: Any) -> Any:
    """Return what is equal of worlds that may be stacked: types and shapes, and plain numbers."""
    if isinstance(memory, np.ndarray):
        return memory.dtype, memory.shape
    if isinstance(memory, tuple):
        return type(memory), tuple(_form(part) for part in memory)
    return memory


def _rows_of(arrays: Sequence[np.ndarray]) -> np.ndarray:
    """Return arrays of one shape as rows of one; numpy's own `stack` moves fields of records."""
    rows = np.zeros((len(arrays), *arrays[0].shape), arrays[0].dtype)
    for row, array in zip(rows, arrays, strict=True):
        row[...] = array
    return rows


def _stacked(memories: Sequence[Any]) -> Any:
    """Return the memory of all worlds: each array has the world in front."""
    columns = zip(*(arrays_of(memory) for memory in memories), strict=True)
    state, workspace, log, parameters, counters = _mapped(
        memories[0], lambda array: _rows_of(next(columns))
    )
    velocities = state.velocities.view(np.uint64).reshape(*state.velocities.shape, -1)
    log = log._replace(pose_bits=log.pose.view(np.uint64), velocity_bits=velocities)
    return state, workspace, log, parameters, counters


@cache
def _kernel_for(spec: Spec) -> Any:
    """Return the kernel of a block of worlds, which takes the memory of each by its address."""

    def make(spec: Spec) -> Any:
        advance = make_advance(spec)

        def advance_worlds(like, places, numbers, block):
            for w in range(block[0], block[1]):
                if numbers.left[w] >= 0:
                    world: Any = memory_at(like, places[w])  # type: ignore[call-arg]
                    params, counters = numbers.parameters[w], numbers.counters[w]
                    numbers.status[w] = advance(
                        world.state, world.workspace, world.log, params, counters, numbers.left[w]
                    )

        return kernel(advance_worlds, spec)

    with uncollected():
        return cached(make, spec)
