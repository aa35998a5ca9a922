"""The CRC by carry-less multiplication is that of zlib, an independent implementation."""

import zlib

import numpy as np
import pytest

from lavendersim.engine.checksum_kernel import is_possible
from lavendersim.trace import checksums

pytestmark = pytest.mark.skipif(not is_possible(), reason="this processor has no such product")


@pytest.fixture(autouse=True)
def of_all_lengths(monkeypatch):
    """Let the kernel have what is short, too: one block is the least."""
    monkeypatch.setattr(checksums, "LONG", 64)


# One block, whole ones, and all lengths of what is left behind them.
@pytest.mark.parametrize("length", [*range(64, 64 + 65), 256, 1000, 65_537])
def test_crc_of_random_bytes_behind_others_is_that_of_zlib(length):
    numbers = np.random.default_rng(length)
    data = numbers.integers(0, 256, length, np.uint8).tobytes()
    before = int(numbers.integers(0, 2**32))
    assert checksums.crc32(data, before) == zlib.crc32(data, before)
    assert checksums.crc32(memoryview(data)) == zlib.crc32(data)


def test_every_flipped_bit_changes_the_crc():
    """A CRC finds every flip of one bit; all lanes and the rest are looked at."""
    data = bytearray(np.random.default_rng(1).integers(0, 256, 200, np.uint8).tobytes())
    whole = checksums.crc32(bytes(data))
    for bit in range(8 * len(data)):
        data[bit // 8] ^= 1 << bit % 8
        assert checksums.crc32(bytes(data)) != whole
        data[bit // 8] ^= 1 << bit % 8


def test_bytes_in_parts_have_the_crc_of_the_whole():
    data = np.random.default_rng(2).integers(0, 256, 5_000, np.uint8).tobytes()
    in_parts = 0
    for begin in range(0, len(data), 777):
        in_parts = checksums.crc32(data[begin : begin + 777], in_parts)
    assert in_parts == zlib.crc32(data)
