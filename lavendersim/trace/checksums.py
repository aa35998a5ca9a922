"""CRC-32 of long data at the speed of memory: folded by carry-less products, finished by zlib.

Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ" (Intel, 2009). Four
16-byte sums x stand for all data up to a place; one that lies 64 bytes before a block y has the
remainder of its first half times K0 and of its second times K1 there:

    x <- clmul(first(x), K0) ^ clmul(second(x), K1) ^ y

and in the end each is folded into the next, 16 bytes behind it, by L0 and L1. What is left has the
CRC of all that was read. zlib itself reads 4 GB/s, this 12 to 14; it is machine code of LLVM, which
a process that runs kernels has in memory, and takes 8 ms to make: for who writes or reads much.
"""

from __future__ import annotations

import ctypes
import platform
import sys
import zlib
from collections.abc import Callable
from functools import cache
from typing import Any, Final

LONG: Final = 16 * 1024  # [byte] of data that is folded,
WORTH: Final = 32 * 1024 * 1024  # [byte] once a process has had so much of it
BLOCK, BLOCKS = 16, 4  # [byte] of a sum, and how many there are
# Remainders of powers of x, bits reversed (Gopal et al., "bit-reflected" CRC-32): for 64 bytes on,
FAR: Final = 0x0154442BD4, 0x01C6E41596
NEAR: Final = 0x01751997D0, 0x00CCAA009E  # and for 16.
ALL_ONES: Final = 0xFFFFFFFF
_had = 0  # [byte] of long data, in this process
Fold = Callable[[int, int, Any], None]  # address of data, blocks of it, the sum it begins with


def crc32(data: bytes | memoryview, value: int = 0) -> int:
    """Return the same as `zlib.crc32`; releases the interpreter lock."""
    global _had
    if len(data) < LONG:
        return zlib.crc32(data, value)
    _had += len(data)  # of two threads at once one may go uncounted
    # Only where LLVM is loaded: a process that reads logs would wait for it longer than for zlib.
    fold = _fold() if _had > WORTH and "numba" in sys.modules else None
    return zlib.crc32(data, value) if fold is None else folded(fold, data, value)


def folded(fold: Fold, data: bytes | memoryview, value: int = 0) -> int:
    """Return the CRC-32 of data of at least 64 bytes."""
    import numpy as np

    count = len(data) // (BLOCK * BLOCKS) * BLOCKS
    # The register of a CRC begins as the complement of the one before, in the first bytes.
    begin = (value ^ ALL_ONES).to_bytes(4, "little").ljust(BLOCK, b"\0")
    left = ctypes.create_string_buffer(begin, BLOCK)
    fold(np.frombuffer(data, np.uint8).ctypes.data, count, left)
    return zlib.crc32(data[count * BLOCK :], zlib.crc32(left.raw, ALL_ONES))


@cache
def _fold() -> Fold | None:
    """Return the machine code; None where this processor, or LLVM for it, has no such product."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return None
    return machine_code()


def machine_code() -> Fold | None:
    """Return the fold compiled for this x86-64 processor; None where it has no such product."""
    from llvmlite import binding as llvm

    features = llvm.get_host_cpu_features()
    if not features.get("pclmul"):
        return None
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=features.flatten(), opt=2
    )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(str(_module())), machine)
    engine.finalize_object()
    kind = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p)
    function: Any = kind(engine.get_function_address("fold"))
    function.engine = engine  # it owns the code
    return function  # type: ignore[no-any-return]


def _module() -> Any:
    """Return the function `fold(data, blocks, left)` in LLVM's language.

    blocks: a multiple of 4, at least 4. left: what goes into the first block; holds what is left.
    """
    from llvmlite import ir

    word, byte = ir.IntType(64), ir.IntType(8)
    pair = ir.VectorType(word, 2)
    module = ir.Module("checksums")
    places = [pair.as_pointer(), word, pair.as_pointer()]
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), places), "fold")
    product = ir.Function(module, ir.FunctionType(pair, [pair, pair, byte]), "llvm.x86.pclmulqdq")
    data, count, left = function.args
    begin, loop, end = (function.append_basic_block(name) for name in ("begin", "loop", "end"))

    def read(at: Any, place: Any) -> Any:
        block = at.load(place)
        block.align = 1
        return block

    def fold(at: Any, one: Any, factors: tuple[int, int], block: Any) -> Any:
        by = ir.Constant(pair, factors)
        parts = [at.call(product, [one, by, ir.Constant(byte, half)]) for half in (0x00, 0x11)]
        return at.xor(at.xor(*parts), block)

    at = ir.IRBuilder(begin)
    first = [read(at, at.gep(data, [ir.Constant(word, k)])) for k in range(BLOCKS)]
    first[0] = at.xor(first[0], read(at, left))
    step = ir.Constant(word, BLOCKS)
    at.cbranch(at.icmp_unsigned(">", count, step), loop, end)

    at = ir.IRBuilder(loop)
    number, sums = at.phi(word), [at.phi(pair) for _ in first]
    blocks = [at.gep(data, [at.add(number, ir.Constant(word, k))]) for k in range(BLOCKS)]
    further = [fold(at, one, FAR, read(at, y)) for one, y in zip(sums, blocks, strict=True)]
    following = at.add(number, step)
    at.cbranch(at.icmp_unsigned("<", following, count), loop, end)
    number.add_incoming(step, begin)
    number.add_incoming(following, loop)

    at = ir.IRBuilder(end)
    last = [at.phi(pair) for _ in first]
    for k, one in enumerate(last):
        for phi in (sums[k], one):
            phi.add_incoming(first[k], begin)
            phi.add_incoming(further[k], loop)
    whole = last[0]
    for block in last[1:]:
        whole = fold(at, whole, NEAR, block)
    at.store(whole, left).align = 1
    at.ret_void()
    return module
