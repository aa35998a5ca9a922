"""Checksums of what is written, where kernels are at hand and where they are not."""

import sys
import zlib

import pytest

from lavendersim.engine import checksum_kernel
from lavendersim.trace.checksums import LONG, crc32

DATA = bytes(range(256)) * (LONG // 128)


@pytest.mark.parametrize("data", [b"", b"a", DATA[:LONG], DATA])
def test_crc_is_that_of_zlib(data):
    assert crc32(data, 7) == zlib.crc32(data, 7)


def test_a_processor_without_the_product_has_the_same_crc(monkeypatch):
    monkeypatch.setattr(checksum_kernel, "is_possible", lambda: False)
    assert crc32(DATA, 7) == zlib.crc32(DATA, 7)


def test_numba_is_not_loaded_for_a_checksum(monkeypatch):
    monkeypatch.delitem(sys.modules, "numba", raising=False)
    assert crc32(DATA, 7) == zlib.crc32(DATA, 7)
    assert "numba" not in sys.modules
