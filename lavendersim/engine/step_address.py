"""What kernels do by addresses alone: call the step of any plan, read a word.

Every plan's step has one form to the machine, whatever its records (`memory_references`): memory is
an address, rows are an address and a count.

    int32 step(int64 *status, void **raised, void *state, void *workspace, void *log,
               void *parameters, int64 1, void *counters, int64 1, int64 steps)

Like `part_compiler` this leans on what numba keeps to itself: how it calls, and that a raised
exception is reported by a result that is not zero.
"""

from __future__ import annotations

from typing import Any, Final

from llvmlite.ir import Constant, FunctionType, IntType
from numba.core import cgutils, types

from .memory_references import BYTES, WORD
from .records import RAISED
from .solvers.packed.lanes import primitive

_int64: Any = types.int64
_STATUS: Final = IntType(32)


@primitive
def step_at(typingctx, code, parts, params, counters, steps):
    """Return what the step whose machine code lies at `code` returns; RAISED where it raised.

    parts: where state, workspace and log lie.
    """

    def call(context, builder, signature, arguments):
        where, memory, params, counters, steps = arguments
        pointer = FunctionType(
            _STATUS,
            [WORD.as_pointer(), BYTES.as_pointer(), *3 * [BYTES], BYTES, WORD, BYTES, WORD, WORD],
        ).as_pointer()
        given = [builder.extract_value(memory, k) for k in range(3)]
        state, workspace, log, params, counters = (
            builder.inttoptr(one, BYTES) for one in (*given, params, counters)
        )
        one = Constant(WORD, 1)
        returned = cgutils.alloca_once_value(builder, Constant(WORD, RAISED))
        raised = cgutils.alloca_once_value(builder, Constant(BYTES, None))
        memory = state, workspace, log
        status = builder.call(
            builder.inttoptr(where, pointer),
            [returned, raised, *memory, params, one, counters, one, steps],
        )
        fine = builder.icmp_signed("==", status, Constant(_STATUS, 0))
        return builder.select(fine, builder.load(returned), Constant(WORD, RAISED))

    return _int64(_int64, types.UniTuple(_int64, 3), _int64, _int64, _int64), call


@primitive
def word_at(typingctx, address):
    """Return the word at an address."""

    def read(context, builder, signature, arguments):
        return builder.load(builder.inttoptr(arguments[0], WORD.as_pointer()))

    return _int64(_int64), read
