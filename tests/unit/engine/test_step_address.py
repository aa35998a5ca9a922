"""Kernels call a step by its address, and read words where they lie."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, compiling, inner

if Kernel is None:
    pytest.skip("this numba compiles kernels whole", allow_module_level=True)

from lavendersim.engine.records import RAISED
from lavendersim.engine.step_address import step_at, word_at

WORD, PLACE = ctypes.c_int64, ctypes.c_void_p
STEP = ctypes.CFUNCTYPE(
    ctypes.c_int32,
    *[ctypes.POINTER(WORD), PLACE, PLACE, PLACE, PLACE, PLACE, WORD, PLACE, WORD, WORD],
)


@pytest.mark.parametrize(("status", "returned"), [(0, 42), (1, RAISED)])
def test_a_step_is_given_what_it_is_called_with(status: int, returned: int) -> None:
    seen: list[Any] = []

    @STEP
    def step(place: Any, raised: Any, *arguments: Any) -> int:
        place[0] = 42
        seen.append(arguments)
        return status

    @inner
    def call(code):
        return step_at(code, (11, 12, 13), 14, 15, 7)

    with compiling():
        assert call(ctypes.cast(step, PLACE).value) == returned
    assert seen == [(11, 12, 13, 14, 1, 15, 1, 7)]


def test_a_word_is_read_where_it_lies() -> None:
    @inner
    def read(address):
        return word_at(address)

    words = np.array([3, -(2**62), 5])
    with compiling():
        assert [read(words.ctypes.data + 8 * k) for k in range(3)] == words.tolist()
