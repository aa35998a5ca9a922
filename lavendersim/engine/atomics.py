"""Words that several threads read and write: atomic loads, stores and sums, and how to wait.

Places are taken as they are given, without bounds. A load that finds the value of a store, or of a
sum, finds what was written before it, too (acquire and release).
"""

from __future__ import annotations

import os
import platform
from typing import Final

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import signature

from .compile import inner
from .solvers.packed.lane_memory import place_of
from .solvers.packed.lanes import primitive

_WORD: Final = ir.IntType(64)
_BYTES: Final = 8
# Looks at a word before a thread that waits offers its processor to others: some 50 us where the
# processor pauses between two, less elsewhere.
SPINS: Final = 2000
_X86: Final = platform.machine().lower() in {"x86_64", "amd64"}
# Whether the system has what threads that wait call.
CAN_WAIT: Final = os.name == "posix"


@primitive
def load(typing, words, at):
    """Return words[at]."""

    def emit(context, builder, sig, args):
        pointer = place_of(context, builder, _WORD, sig.args[0], *args)
        return builder.load_atomic(pointer, "acquire", _BYTES)

    return signature(types.int64, words, at), emit


@primitive
def store(typing, words, at, value):
    """Write words[at]."""

    def emit(context, builder, sig, args):
        array, at, value = args
        pointer = place_of(context, builder, _WORD, sig.args[0], array, at)
        builder.store_atomic(value, pointer, "release", _BYTES)
        return context.get_dummy_value()

    return signature(types.void, words, at, types.int64), emit


@primitive
def fetch_add(typing, words, at, value):
    """Add to words[at]; return what it was before."""

    def emit(context, builder, sig, args):
        array, at, value = args
        pointer = place_of(context, builder, _WORD, sig.args[0], array, at)
        return builder.atomic_rmw("add", pointer, value, "acq_rel")

    return signature(types.int64, words, at, types.int64), emit


@primitive
def _replace(typing, words, at, before, after):
    """Write words[at] if it is `before`; return whether it was."""

    def emit(context, builder, sig, args):
        array, at, before, after = args
        pointer = place_of(context, builder, _WORD, sig.args[0], array, at)
        found = builder.cmpxchg(pointer, before, after, "acq_rel", "acquire")
        return builder.extract_value(found, 1)

    return signature(types.boolean, words, at, types.int64, types.int64), emit


@primitive
def _pause(typing):
    """Tell the processor that this thread waits."""

    def emit(context, builder, sig, args):
        if _X86:
            kind = ir.FunctionType(ir.VoidType(), [])
            builder.call(builder.module.declare_intrinsic("llvm.x86.sse2.pause", (), kind), [])
        return context.get_dummy_value()

    return signature(types.void), emit


@primitive
def _give_way(typing):
    """Offer the processor to another thread."""

    def emit(context, builder, sig, args):
        if CAN_WAIT:  # else there is no team, and the symbol is none of the system
            kind = ir.FunctionType(ir.IntType(32), [])
            builder.call(cgutils.get_or_insert_function(builder.module, kind, "sched_yield"), [])
        return context.get_dummy_value()

    return signature(types.void), emit


@inner
def raise_to(words, at, value):
    """Write words[at] if it is less; return whether it was. Of several threads one writes."""
    before = load(words, at)
    while before < value:
        if _replace(words, at, before, value):
            return True
        before = load(words, at)
    return False


@inner
def wait(spins):
    """Wait a moment, after so many; return how many it was."""
    if spins < SPINS:
        _pause()
    else:
        _give_way()
    return spins + 1
