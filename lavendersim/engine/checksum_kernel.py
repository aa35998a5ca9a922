"""CRC-32 of many bytes by carry-less multiplication, 64 at a time (Gopal et al., Intel, 2009).

A CRC is the rest of the bytes, as a polynomial over two elements, by that of degree 32. What stands
n bits before the end may be multiplied by the rest of x^n without changing it, so 64 bytes are
folded onto the next 64, in four lanes:

    lane        lo(lane) * (rest of x^(512 + 64))  +  hi(lane) * (rest of x^512)  +  next lane

until one lane of 16 bytes is left, whose CRC, with what follows it, is that of all. Bits are
reflected, as in zlib. Processors without such a product have no kernel here.
"""

from __future__ import annotations

import platform
from functools import cache
from typing import Any, Final

import numpy as np
from llvmlite import binding, ir
from numba import config
from numba.core import cgutils, types
from numba.core.typing.templates import signature

from .compile import compiling, inner
from .kernel_cache import cached
from .solvers.packed.lanes import primitive
from .spec import Spec

FOLDED: Final = 64  # bytes at a time, and at the least
LANE: Final = 16  # bytes of one
_WORD, _BYTE, _PLACE = ir.IntType(64), ir.IntType(8), ir.IntType(32)
_LANE: Final = ir.VectorType(_WORD, 2)
_PRODUCT: Final = ir.FunctionType(_LANE, [_LANE, _LANE, _BYTE])
# Rests of x^(512 + 64 - 32), x^(512 - 32), x^(128 + 64 - 32) and x^(128 - 32), reflected.
_BY_FOUR: Final = (0x154442BD4, 0x1C6E41596)
_BY_ONE: Final = (0x1751997D0, 0x0CCAA009E)


@cache
def is_possible() -> bool:
    """Whether the processor that kernels are compiled for is known to multiply so."""
    is_x86 = platform.machine().lower() in {"x86_64", "amd64"}
    own = config.CPU_NAME is None and config.CPU_FEATURES is None  # type: ignore[attr-defined]
    return is_x86 and own and bool(binding.get_host_cpu_features().get("pclmul"))


@primitive
def _fold(typing, data, blocks, lanes):
    """Fold blocks of bytes onto the lane that `lanes` has, which is added to the first."""

    def emit(context, builder, sig, args):
        bytes_of, count, out = args
        data = context.make_array(sig.args[0])(context, builder, bytes_of).data
        out = context.make_array(sig.args[2])(context, builder, out).data
        product = cgutils.get_or_insert_function(builder.module, _PRODUCT, "llvm.x86.pclmulqdq")

        def load(place: Any, number: int) -> Any:
            at = builder.gep(place, [ir.Constant(_PLACE, LANE * number)])
            return builder.load(builder.bitcast(at, _LANE.as_pointer()), align=1)

        def folded(lane: Any, by: tuple[int, int], onto: Any) -> Any:
            factors = ir.Constant(_LANE, by)
            low, high = (
                builder.call(product, [lane, factors, ir.Constant(_BYTE, which)])
                for which in (0x00, 0x11)
            )
            return builder.xor(builder.xor(low, high), onto)

        kept = builder.bitcast(out, _LANE.as_pointer())
        lanes = [cgutils.alloca_once_value(builder, load(data, k)) for k in range(4)]
        first = builder.xor(builder.load(lanes[0]), builder.load(kept, align=1))
        builder.store(first, lanes[0])
        one = ir.Constant(_WORD, 1)
        with cgutils.for_range_slice(builder, one, count, one) as (block, _):
            start = builder.gep(data, [builder.mul(block, ir.Constant(_WORD, FOLDED))])
            for number, lane in enumerate(lanes):
                onto = load(start, number)
                builder.store(folded(builder.load(lane), _BY_FOUR, onto), lane)
        left = builder.load(lanes[0])
        for lane in lanes[1:]:
            left = folded(left, _BY_ONE, builder.load(lane))
        builder.store(left, kept, align=1)
        return context.get_dummy_value()

    return signature(types.void, data, blocks, lanes), emit


def _make_fold(spec: Spec) -> Any:
    def fold(data, blocks, lane):
        _fold(data, blocks, lane)

    return inner(fold)


@cache
def fold_bytes() -> Any:
    """Return `kernel(data, blocks, lane)`: 64 bytes times `blocks`, one at least, in one lane.

    data: uint8 (n,), of which so many are read, whatever n. lane: uint64 (2,), what is added to
    the first 16 bytes, as `zlib` adds the CRC of what came before; then what all are folded to.
    """
    kernel = cached(_make_fold, Spec())
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(np.zeros(FOLDED, np.uint8), 1, np.zeros(2, np.uint64))
    return kernel
