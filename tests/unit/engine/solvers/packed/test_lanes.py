"""Every primitive does to each of eight numbers what it does to one: the bits that numpy has."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import kernel
from lavendersim.engine.solvers.packed.lane_memory import (
    put_eight,
    put_one,
    take_eight,
    take_one,
    take_triple,
    take_triples,
)
from lavendersim.engine.solvers.packed.lanes import (
    WIDTH,
    any_greater,
    clamped,
    greater,
    lane,
    magnitude,
    positive,
    root,
    total,
    where_greater,
    zeros,
)
from lavendersim.engine.spec import Spec

# Signs, zeros, ties, a NaN: by place, not drawn.
FIRST = np.array([1.5, -2.5, 0.0, -0.0, 3.0, np.nan, 1e-300, -7.0])
SECOND = np.array([2.0, 1.0, 0.0, 2.0, 3.0, 1.0, 0.5, 6.5])
RESULTS = 12


@cache
def compiled(eight: bool) -> Any:
    take, put = (take_eight, put_eight) if eight else (take_one, put_one)
    step = WIDTH if eight else 1

    def run(x, y, out, found):
        for k in range(0, WIDTH, step):
            a, b = take(x, k), take(y, k)
            put(out[0], k, a + b)
            put(out[1], k, a - b)
            put(out[2], k, a * b)
            put(out[3], k, a / (b * b + b * b))
            put(out[4], k, positive(a))
            put(out[5], k, magnitude(a))
            put(out[6], k, root(b))
            put(out[7], k, greater(a, b))
            put(out[8], k, where_greater(a, b, b, a))
            put(out[9], k, clamped(a, b))
            # Products are rounded before they are added: nothing is contracted.
            put(out[10], k, a * b + a * a)
            found[k] = any_greater(a, b)
            if eight:
                put(out[11], k, zeros())
                for j in range(WIDTH):
                    found[WIDTH + j] = lane(a, j) > 0.0

    return kernel(run, Spec())


@pytest.mark.parametrize("eight", [False, True], ids=["one", "eight"])
def test_numbers_have_the_bits_of_numpy(eight: bool) -> None:
    x, y = FIRST, np.where(SECOND == 0.0, 0.25, SECOND)
    out, found = np.full((RESULTS, WIDTH), 0.5), np.zeros(2 * WIDTH, np.bool_)
    compiled(eight)(x, y, out, found)
    expected = [
        x + y, x - y, x * y, x / (y * y + y * y),
        np.where(x < 0.0, 0.0, x), np.abs(x), np.sqrt(y),
        np.where(x > y, x, y), np.where(x > y, y, x),
        np.where(x < -y, -y, np.where(x > y, y, x)), x * y + x * x,
    ]  # fmt: skip
    for k, one in enumerate(expected):
        np.testing.assert_array_equal(out[k], one, err_msg=f"result {k}")
    if eight:
        np.testing.assert_array_equal(out[11], 0.0)
        assert not found[0]  # no x is above its y here
        np.testing.assert_array_equal(found[WIDTH:], x > 0.0)
    else:
        np.testing.assert_array_equal(found[:WIDTH], x > y)


@pytest.mark.parametrize("place", range(WIDTH))
def test_any_lane_that_is_greater_is_seen(place: int) -> None:
    x, found = np.zeros(WIDTH), np.zeros(2 * WIDTH, np.bool_)
    x[place] = 2.0
    compiled(True)(x, np.ones(WIDTH), np.zeros((RESULTS, WIDTH)), found)
    assert found[0]


@cache
def compiled_vectors(eight: bool) -> Any:
    take, put = (take_eight, put_eight) if eight else (take_one, put_one)
    take_vector = take_triples if eight else take_triple
    step = 3 * WIDTH if eight else 4

    def run(a, b, numbers, out):
        for k in range(0, len(a), step):
            i = k // step
            u, v, number = take_vector(a, k), take_vector(b, k), take(numbers, i)
            put(out[0], i, total(u + v))
            put(out[1], i, total(u - v))
            put(out[2], i, total(u * v))
            put(out[3], i, total(u * number))

    return kernel(run, Spec())


@pytest.mark.parametrize("eight", [False, True], ids=["one", "eight"])
def test_vectors_are_added_multiplied_and_summed_in_one_order(eight: bool, rng) -> None:
    u, v, numbers = rng.normal(size=(3, WIDTH)), rng.normal(size=(3, WIDTH)), rng.normal(size=WIDTH)
    out = np.zeros((4, WIDTH))
    if eight:
        given = u.ravel(), v.ravel()
    else:  # x, y, z and one that is never looked at
        rest = np.full((1, WIDTH), np.nan)
        given = tuple(np.vstack([one, rest]).T.ravel() for one in (u, v))
    compiled_vectors(eight)(*given, numbers, out)
    for k, one in enumerate((u + v, u - v, u * v, u * numbers)):
        np.testing.assert_array_equal(out[k], (one[0] + one[1]) + one[2], err_msg=f"result {k}")
