"""Kernels of lanes called with plain arrays of eight."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from packed_scenes import BLOCKS

from lavendersim.engine.compile import kernel
from lavendersim.engine.solvers.packed.lane_memory import put_eight, put_one, take_eight, take_one
from lavendersim.engine.solvers.packed.lanes import WIDTH


def one_and_eight(
    make: Callable[..., Any], given: Sequence[np.ndarray], results: int, eight: bool
) -> np.ndarray:
    """Return what the kernel of `make` gives for eight cases: all at once, or one after the other.

    make: (spec) -> kernel of three arguments that returns a tuple of two.
    """
    function = make(BLOCKS)
    take, put = (take_eight, put_eight) if eight else (take_one, put_one)
    step = WIDTH if eight else 1

    def call(numbers, found):
        for k in range(0, WIDTH, step):
            first, second = function(
                take(numbers, k), take(numbers, WIDTH + k), take(numbers, 2 * WIDTH + k)
            )
            put(found, k, first)
            put(found, WIDTH + k, second)

    found = np.zeros(results * WIDTH)
    kernel(call, BLOCKS)(np.concatenate(given), found)
    return found.reshape(results, WIDTH)
