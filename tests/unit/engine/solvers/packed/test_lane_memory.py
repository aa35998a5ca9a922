"""Lanes are read from and written to the places asked for, eight bodies at a time as one by one."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from lavendersim.engine.compile import kernel
from lavendersim.engine.solvers.packed.lane_memory import (
    STRIDE,
    put_bodies,
    put_body,
    put_eight,
    put_one,
    take_bodies,
    take_body,
    take_eight,
    take_one,
    take_triple,
    take_triples,
)
from lavendersim.engine.solvers.packed.lanes import WIDTH, total
from lavendersim.engine.spec import Spec

BODIES = 11
OWN = 2  # the line that takes what is written of a line before it


@cache
def doubled(eight: bool) -> Any:
    """Return a kernel: bodies' first vectors by those of `rows`, the second by 1 minus that."""

    def by_eights(state, ends, at, rows):
        first, second = take_bodies(state, ends, at)
        factors = take_triples(rows, 0)
        put_bodies(state, ends, at, OWN * STRIDE, (first * factors, second - second * factors))

    def one_by_one(state, ends, at, rows):
        for k in range(WIDTH):
            first, second = take_body(state, ends, at + k)
            factors = take_triple(rows, 4 * k)
            put_body(
                state, ends, at + k, OWN * STRIDE, (first * factors, second - second * factors)
            )

    return kernel(by_eights if eight else one_by_one, Spec())


@pytest.mark.parametrize("eight", [True, False], ids=["eights", "one by one"])
def test_each_body_has_its_own_vectors_and_no_other_is_touched(eight: bool, rng) -> None:
    state = rng.normal(size=(BODIES, STRIDE))
    bodies = OWN + 1 + rng.permutation(BODIES - OWN - 1)[:WIDTH]
    ends = np.concatenate([[-1, -1], bodies * STRIDE])  # from the third on
    factors = rng.normal(size=(3, WIDTH))
    rows = factors.ravel()
    if not eight:
        rows = np.vstack([factors, np.full(WIDTH, 9.0)]).T.ravel()
    expected = state.copy()
    for k, i in enumerate(bodies):
        expected[i, :3] *= factors[:, k]
        expected[i, 4:7] -= expected[i, 4:7] * factors[:, k]
        expected[i, 3], expected[i, 7] = 0.0, 0.0  # what lies behind a vector
    found = state.ravel().copy()
    doubled(eight)(found, ends, 2, rows)
    np.testing.assert_array_equal(found.reshape(BODIES, STRIDE), expected)


@pytest.mark.parametrize("line", [0, OWN - 1])
def test_what_nothing_moves_is_read_where_it_is_and_written_elsewhere(line: int, rng) -> None:
    """All lanes write the line of their thread, and the last is kept: nobody reads it."""
    state = rng.normal(size=STRIDE * (OWN + 1))
    ends, factors = np.full(WIDTH, line * STRIDE), rng.normal(size=(3, WIDTH))
    before = state.copy()
    doubled(True)(state, ends, 0, factors.ravel())
    np.testing.assert_array_equal(state[: OWN * STRIDE], before[: OWN * STRIDE])
    own = state[OWN * STRIDE :][:3]
    np.testing.assert_array_equal(own, before[line * STRIDE :][:3] * factors[:, -1])


@cache
def moved() -> Any:
    def run(rows, out, at):
        put_one(out, 0, take_one(rows, at))
        put_eight(out, 1, take_eight(rows, at))
        put_one(out, 9, total(take_triple(rows, at)))
        put_eight(out, 10, total(take_triples(rows, at)))

    return kernel(run, Spec())


@pytest.mark.parametrize("at", [0, 3, 8])
def test_numbers_are_taken_from_their_place_aligned_or_not(at: int) -> None:
    """Powers of two: a sum tells which were added."""
    rows = 2.0 ** np.arange(40)
    out = np.full(20, -1.0)
    moved()(rows, out, at)
    assert out[0] == rows[at]
    np.testing.assert_array_equal(out[1:9], rows[at : at + 8])
    assert out[9] == rows[at : at + 3].sum()
    np.testing.assert_array_equal(out[10:18], rows[at : at + 24].reshape(3, 8).sum(axis=0))
    np.testing.assert_array_equal(out[18:], -1.0)
