"""What is folded by machine code has zlib's CRC-32 of all that was read."""

from __future__ import annotations

import zlib

import numpy as np
import pytest

from lavendersim.engine.crc_fold import machine_code
from lavendersim.trace.checksums import ALL_ONES, folded

# One loop of four blocks, none, several, each with and without bytes behind it.
LENGTHS = (64, 65, 127, 128, 191, 192, 1000, 65537)
BEFORE = (0, 1, ALL_ONES, 0x12345678)


def test_folded_sums_are_those_of_zlib() -> None:
    fold = machine_code()
    if fold is None:
        pytest.skip("this processor has no carry-less product")
    for length in LENGTHS:
        data = np.random.default_rng(length).bytes(length)
        for before in BEFORE:
            assert folded(fold, data, before) == zlib.crc32(data, before), (length, before)
