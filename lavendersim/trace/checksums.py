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
    from lavendersim.engine.crc_fold import machine_code  # late: LLVM

    return machine_code()  # type: ignore[no-any-return]
