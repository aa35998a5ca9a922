"""Many worlds in one call: engines of one plan whose arrays have the world as their first axis.

    worlds = Worlds([engine, ...])           each engine's arrays become rows of arrays of all
    statuses = worlds.advance(240, threads=2)
    rows = [engine.take_rows() for engine in engines]

They advance by one call of a kernel, a thread for a block of worlds (`together`): bits are those of
the engine alone. An engine stays one, whose steps, rows and events are its own. One that needs more
room than the worlds were given gets arrays of its own, and is of the call all the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import itemgetter
from typing import Any

import numpy as np

from .engine import Engine
from .memory import arrays_of
from .together import advance_together


class Worlds:
    """Engines of one plan that advance together."""

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
        whole = _stacked(memories)
        for number, engine in enumerate(self.engines):
            view = _mapped(whole, itemgetter(number))
            engine.state, engine.workspace, engine.log, engine.parameters, engine.counters = view
            engine.note_memory()

    def advance(self, steps: int, threads: int = 1) -> list[int]:
        """Do up to so many steps of every world; return what `Engine.advance` returns of each."""
        each = [steps] * len(self.engines)
        return [one.status for one in advance_together(self.engines, each, threads)]


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
