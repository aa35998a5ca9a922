"""CRC-32 of what is written, by a kernel where one is at hand: some three times as fast as zlib."""

from __future__ import annotations

import sys
import zlib
from typing import Final

import numpy as np

LONG: Final = 16 * 1024  # [B] from which on a kernel takes less time


def crc32(data: bytes | memoryview, before: int = 0) -> int:
    """Return the same as `zlib.crc32`; before: that of what stands before."""
    # Who writes without numba, to recover a log, does not wait for it to be loaded.
    if len(data) < LONG or "numba" not in sys.modules:
        return zlib.crc32(data, before)
    from lavendersim.engine.checksum_kernel import FOLDED, fold_bytes, is_possible  # late: numba

    if not is_possible():
        return zlib.crc32(data, before)
    data = memoryview(data)
    blocks = len(data) // FOLDED
    every_bit = 0xFFFFFFFF
    lane = np.array([before ^ every_bit, 0], np.uint64)
    fold_bytes()(np.frombuffer(data, np.uint8), blocks, lane)
    # Of the lane and the rest nothing stands before, where zlib would begin with every bit.
    return zlib.crc32(lane.tobytes() + data[blocks * FOLDED :], every_bit)
