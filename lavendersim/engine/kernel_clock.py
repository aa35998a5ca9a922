"""The clock that kernels read."""

from __future__ import annotations

import time
from typing import Any, Final

from llvmlite.ir import ArrayType, Constant, FunctionType, IntType
from numba.core import cgutils, types
from numba.core.typing.templates import signature

from .solvers.packed.lanes import primitive

_WORD, _STATUS = IntType(64), IntType(32)
_BYTES: Final = IntType(8).as_pointer()
# Of POSIX: it never goes back. Elsewhere kernels have none.
CLOCK: Final = getattr(time, "CLOCK_MONOTONIC", None)


@primitive
def nanoseconds(typing):
    """Return the time of a clock that only goes on [ns]; 0 where there is none."""

    def emit(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if CLOCK is None:
            return Constant(_WORD, 0)
        kind = FunctionType(_STATUS, [_STATUS, _BYTES])
        function = cgutils.get_or_insert_function(builder.module, kind, "clock_gettime")
        place = cgutils.alloca_once(builder, ArrayType(_WORD, 2))
        builder.call(function, [Constant(_STATUS, CLOCK), builder.bitcast(place, _BYTES)])
        seconds, rest = (builder.extract_value(builder.load(place), k) for k in range(2))
        return builder.add(builder.mul(seconds, Constant(_WORD, 10**9)), rest)

    return signature(types.int64), emit
