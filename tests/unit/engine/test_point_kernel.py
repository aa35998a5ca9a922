"""Points for viewers are float32: positions on their grid, all else cut, coloured by load."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from lavendersim.engine.point_kernel import lay_points

KEPT, LOADED, UNLOADED = 0xFFFFF000, 0xFF112233, 0xFF445566


def cut(number: float) -> bytes:
    (word,) = struct.unpack("<I", struct.pack("<f", number))
    return struct.pack("<I", word & KEPT)


@pytest.mark.parametrize("grid", [0.0, 0.001])
@pytest.mark.parametrize("loaded_by", [-1, 5])
def test_points_are_packed_one_behind_the_other_from_each_start(grid, loaded_by, rng) -> None:
    numbers = rng.normal(size=(5, 6))
    numbers[:, 5] = [1.0, 0.0, -1.0, 2.0, 0.0]
    columns = np.array([2, 0, 1, 4])  # positions first, then one that is cut
    starts, counts = np.array([100, 8]), np.array([2, 3])
    data = np.zeros(200, np.uint8)
    floats = np.zeros(4, np.float32)
    masks = (np.uint32(KEPT), np.uint32(LOADED), np.uint32(UNLOADED))
    choices = (grid, loaded_by, masks)
    lay_points()(
        data, (starts, counts), numbers, columns, choices, (floats, floats.view(np.uint32))
    )
    expected, row = bytearray(200), 0
    for start, count in zip(starts, counts, strict=True):
        message = b""
        for _ in range(count):
            exact = [numbers[row, k] for k in columns[:3]]
            if grid:
                exact = [np.rint(x / grid) * grid for x in exact]
            message += b"".join(struct.pack("<f", np.float32(x)) for x in exact)
            message += cut(np.float32(numbers[row, 4]))
            bright = loaded_by < 0 or numbers[row, 5] > 0.0
            message += struct.pack("<I", LOADED if bright else UNLOADED)
            row += 1
        expected[start : start + len(message)] = message
    assert data.tobytes() == bytes(expected)
