"""Engines of one plan that advance in one call of a kernel, a thread for each share of them.

    statuses = advance_together(engines, [240, 240, 100], threads=2)

One kernel serves every plan. It is given where the machine code of the plan's step lies, and of
each engine the array objects that its memory consists of. Of these it lays that memory out as
kernels read it (`memory_references`), calls the step, and goes on with the next engine, without the
interpreter. So arrays stay where they are, nothing is compiled for the plan once more, and bits are
those of each engine alone. An engine that needs more room, or that kernels do not read by addresses
(another numba, another system), advances by itself.
"""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from .compile import Kernel, compiling, inner
from .engine import Engine
from .kernel_cache import cached
from .kernel_clock import nanoseconds
from .memory import arrays_of
from .records import CONTACTS_FULL, PAIRS_FULL, RAISED, ROWS_FULL, RUNNING, WOKEN
from .spec import Spec

# An engine that returns one of these goes on by itself: it makes room for its step.
_UNFINISHED: Final = (CONTACTS_FULL, PAIRS_FULL, ROWS_FULL, WOKEN, RAISED)
NO_LIMIT: Final = 2**62  # [ns]
# Words of an array object of numpy behind what every object has: public, the same in all versions.
HEAD: Final = object.__basicsize__
_DATA, _SHAPE, _STRIDES = HEAD, HEAD + 16, HEAD + 24
_SPENT, _LEFT, _STATUS = 0, 1, 2  # columns of a call
_AXES, _ITEM = 0, 1  # columns of the form of memory


class EngineAdvance(NamedTuple):
    """What one engine did in a call."""

    status: int  # as `Engine.advance` returns it; RUNNING with no step where time was up before
    spent: int  # [ns] by the clock on the wall


def advance_together(
    engines: Sequence[Engine],
    steps: Sequence[int],
    threads: int = 1,
    within: int = NO_LIMIT,
) -> list[EngineAdvance]:
    """Do up to so many steps of each engine.

    Those of one machine code advance in one call. within: [ns] after which no other engine begins.
    """
    targets = [
        int(engine.counters["step"][0]) + more for engine, more in zip(engines, steps, strict=True)
    ]
    found: dict[int, EngineAdvance] = {}
    groups: dict[Any, list[int]] = {}
    for number, engine in enumerate(engines):
        groups.setdefault(engine.kind, []).append(number)
    for members in groups.values():
        code = engines[members[0]].machine_code if len(members) > 1 else 0
        if code and is_possible():
            of_group = [engines[number] for number in members]
            left = [steps[number] for number in members]
            found |= zip(members, _in_one_call(of_group, left, code, threads, within), strict=True)
    for number, engine in enumerate(engines):
        one = found.get(number, EngineAdvance(RAISED, 0))
        if one.status in _UNFINISHED:
            begin = time.perf_counter_ns()
            status = engine.advance(targets[number] - int(engine.counters["step"][0]))
            found[number] = EngineAdvance(status, one.spent + time.perf_counter_ns() - begin)
    return [found[number] for number in range(len(engines))]


@cache
def is_possible() -> bool:
    """Whether kernels hand memory on by addresses, and the system has the clock."""
    if Kernel is None or os.name != "posix" or HEAD != 16:
        return False
    from .kernel_lowering import are_direct  # late: another numba may not have what it needs

    return are_direct()


def _in_one_call(
    engines: Sequence[Engine], steps: Sequence[int], code: int, threads: int, within: int
) -> list[EngineAdvance]:
    form, begins, words = _form_of(engines[0])
    call = np.empty((len(engines), 3), np.int64)
    call[:, _SPENT], call[:, _LEFT], call[:, _STATUS] = 0, steps, RUNNING
    objects = np.array([engine.array_objects() for engine in engines])
    memory = np.empty((len(engines), words), np.int64)
    where = code, memory.ctypes.data, begins, within
    advance = partial(advance_engines(), where, objects, form, memory, call)
    ends = np.linspace(0, len(engines), min(threads, len(engines)) + 1).astype(int).tolist()
    blocks = [*pairwise(ends)]
    if len(blocks) == 1:
        advance(blocks[0])
    else:
        with ThreadPoolExecutor(len(blocks)) as pool:
            list(pool.map(advance, blocks))
    return [EngineAdvance(status, spent) for spent, _, status in call.tolist()]


class _Form(NamedTuple):
    """How the memory of engines of one kind lies, in words."""

    # (arrays, 2) axes of each, and size [B] of an item; parameters and counters come last
    arrays: np.ndarray
    begins: tuple[int, int]  # words behind which the workspace and the log begin
    words: int


_forms: dict[Any, _Form] = {}


def _form_of(engine: Engine) -> _Form:
    found = _forms.get(engine.kind)
    if found is None:
        parts = [[*arrays_of(part)] for part in (engine.state, engine.workspace, engine.log)]
        state, workspace, log = (sum(5 + 2 * array.ndim for array in part) for part in parts)
        rows = [(array.ndim, array.itemsize) for part in parts for array in part]
        arrays = np.array([*rows, (1, 0), (1, 0)])
        found = _Form(arrays, (state, state + workspace), state + workspace + log)
        _forms[engine.kind] = found
    return found


@cache
def advance_engines() -> Any:
    """Return `kernel(where, objects, form, memory, call, block)`: the engines of a block advance.

    where: address of the step's code, of `memory`, words before the workspace and before the log,
    time [ns]. objects: (n, arrays) places of array objects. form: see `_Form`. memory: (n, words)
    of what it lays out. call: (n, 3) what each took [ns], its steps to do, what it returned.
    """
    kernel = cached(_make_advance_engines, Spec())
    none = np.empty((0, 3), np.int64)
    with compiling():  # here, and not in one of several threads
        kernel((0, 0, (0, 0), 0), none, none, none, none, (0, 0))
    return kernel


def _make_advance_engines(spec: Spec) -> Any:
    from .step_address import step_at, word_at  # late, as above

    def advance_engines(where, objects, form, memory, call, block):
        code, place, begins, within = where
        arrays, words = len(form) - 2, memory.shape[1]
        begin: Any = nanoseconds()
        now = begin
        for w in range(block[0], block[1]):
            if now - begin > within:
                break
            at = 0
            for k in range(arrays):
                axes, items = form[k, _AXES], 1
                shape = word_at(objects[w, k] + _SHAPE)
                strides = word_at(objects[w, k] + _STRIDES)
                for axis in range(axes):
                    length = word_at(shape + 8 * axis)
                    items *= length
                    memory[w, at + 5 + axis] = length
                    memory[w, at + 5 + axes + axis] = word_at(strides + 8 * axis)
                memory[w, at], memory[w, at + 1] = 0, 0
                memory[w, at + 2], memory[w, at + 3] = items, form[k, _ITEM]
                memory[w, at + 4] = word_at(objects[w, k] + _DATA)
                at += 5 + 2 * axes
            state = place + 8 * words * w
            parts = state, state + 8 * begins[0], state + 8 * begins[1]
            params = word_at(objects[w, arrays] + _DATA)
            counters = word_at(objects[w, arrays + 1] + _DATA)
            call[w, _STATUS] = step_at(code, parts, params, counters, call[w, _LEFT])
            after: Any = nanoseconds()
            call[w, _SPENT] = after - now
            now = after

    return inner(advance_engines)
