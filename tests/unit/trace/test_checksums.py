"""The folded CRC-32 is zlib's, of data of any length and behind any other."""

from __future__ import annotations

import zlib

import numba  # noqa: F401  (where it is loaded, long data is folded)
import numpy as np
import pytest

from lavendersim.trace import checksums
from lavendersim.trace.checksums import LONG, WORTH, crc32


@pytest.fixture(autouse=True)
def _much_was_had(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checksums, "_had", WORTH)


def random_bytes(length: int) -> bytes:
    return np.random.default_rng(length).bytes(length)


def test_data_of_zeros_and_of_ones_is_summed_as_zlib_does() -> None:
    for byte in (b"\x00", b"\xff"):
        data = byte * (LONG + 7)
        assert crc32(data) == zlib.crc32(data)


def test_long_data_is_summed_in_parts_as_in_one_from_any_buffer() -> None:
    data = random_bytes(2 * LONG + 5)
    whole = zlib.crc32(data)
    assert crc32(memoryview(data)) == whole
    assert crc32(data[LONG + 3 :], crc32(data[: LONG + 3])) == whole
    assert crc32(data[:10]) == zlib.crc32(data[:10])


def test_other_processors_leave_it_to_zlib(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    checksums._fold.cache_clear()
    data = random_bytes(LONG)
    try:
        assert checksums._fold() is None
        assert crc32(data) == zlib.crc32(data)
    finally:
        checksums._fold.cache_clear()


def test_a_process_that_has_little_of_it_makes_no_machine_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(checksums, "_had", 0)
    monkeypatch.setattr(checksums, "_fold", lambda: pytest.fail("it takes longer than zlib"))
    data = random_bytes(LONG)
    assert crc32(data) == zlib.crc32(data)
    assert checksums._had == LONG
