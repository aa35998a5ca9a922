"""Where columns of steps are largest, and what others count, by one kernel in one pass.

numpy takes a pass for each, and each gives the interpreter's lock away and waits for it.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.engine.compile import call, inner
from lavendersim.engine.kernel_cache import cached
from lavendersim.engine.spec import Spec
from lavendersim.trace.message_form import columns_of_words, words_of


class Largest(NamedTuple):
    """Of some steps, at least one."""

    rows: list[int]  # where each number is largest: the first NaN, else the first of the largest
    sums: list[int]  # of each column that counts
    steps: list[int]  # in which it is not 0


def _make_find(spec: Spec) -> Any:
    def find_largest(words, numbers, columns, counted, rows, sums):
        for j in range(columns.shape[0]):
            k, at = columns[j], 0
            most = numbers[0, k]
            for i in range(1, numbers.shape[0]):
                one = numbers[i, k]
                if most == most and (one > most or one != one):
                    most, at = one, i
            rows[j] = at
        for j in range(counted.shape[0]):
            k, total, steps = counted[j], 0, 0
            for i in range(words.shape[0]):
                total += words[i, k]
                steps += words[i, k] != 0
            sums[j, 0], sums[j, 1] = total, steps

    return inner(find_largest)


@cache
def _kernel() -> Any:
    return cached(_make_find, Spec())


def largest_of(step: NDArray[Any], numbers: tuple[str, ...], counts: tuple[str, ...]) -> Largest:
    """Return where numbers of steps are largest, and what counts come to; columns by name."""
    words = words_of(step)
    columns, counted = _places(step.dtype, numbers), _places(step.dtype, counts)
    rows, sums = np.zeros(len(columns), np.int64), np.zeros((len(counted), 2), np.int64)
    call(_kernel(), words.view(np.int64), words.view(np.float64), columns, counted, rows, sums)
    return Largest(rows.tolist(), sums[:, 0].tolist(), sums[:, 1].tolist())


def _places(row: np.dtype[Any], names: tuple[str, ...]) -> NDArray[np.int64]:
    places = columns_of_words(row)
    return np.array([places[name] for name in names], np.int64)
