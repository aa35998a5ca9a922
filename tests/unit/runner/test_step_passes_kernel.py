"""The passes that kernels make while a cell runs give the numbers that numpy gives of its log.

Two algorithms, row by row and column by column, of rows that are as wrong as a falsified log can
be: equal to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from lavendersim.measures import step_passes
from lavendersim.measures.step_passes import (
    LOWEST,
    SO_FAR,
    EnergyRows,
    MomentumRows,
)
from lavendersim.runner import step_passes_kernel

STATES, BODIES = 500, 6
WRONG = [0.0, 0.01, 0.3]  # the share of numbers that are out of all bounds
# NaN, infinite, nothing, and what squares to more or less than there are numbers
OUT = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e300, -1e300, 5e-324]
Draw = Callable[..., np.ndarray]


@pytest.fixture(params=WRONG)
def draw(request: pytest.FixtureRequest) -> Draw:
    random = np.random.default_rng(7)

    def numbers(*shape: int) -> np.ndarray:
        right = random.normal(size=shape) * 10.0 ** random.integers(-3, 3, shape)
        return np.where(random.random(shape) < request.param, random.choice(OUT, shape), right)

    return numbers


@pytest.fixture(autouse=True)
def _without_warnings() -> Iterator[None]:
    with np.errstate(all="ignore"):
        yield


def assert_same(one: np.ndarray, other: np.ndarray) -> None:
    assert np.array_equal(one, other, equal_nan=True)
    assert one.dtype == other.dtype


def test_numbers_that_are_not_finite(draw: Draw) -> None:
    step = np.zeros(STATES, [("step", "i8"), ("x", "f8"), ("worst", "i8"), ("y", "f8")])
    step["x"], step["y"], step["worst"] = draw(STATES), draw(STATES), -1
    pose = draw(STATES, BODIES, 7)
    given = step_passes_kernel.not_finite(step, pose)
    assert_same(given, step_passes.not_finite(step, pose))
    without = np.empty((STATES, 0, 0))
    found = step_passes_kernel.not_finite(step, without)
    assert_same(found, step_passes.not_finite(step, without))
    expected = ~np.isfinite(step["x"]) * 1.0 + ~np.isfinite(step["y"])
    assert_same(found, expected)


@pytest.mark.parametrize("share", [None, 0.1])
def test_the_fastest_body(draw: Draw, share: float | None) -> None:
    pose = draw(STATES, BODIES, 7)
    pose[:, 2] = pose[:, 1]  # of two that are as fast the first counts
    elapsed = np.full(STATES - 1, 1.0 / 240.0)
    moved = None
    if share is not None:
        moved = np.random.default_rng(2).random((STATES - 1, BODIES)) < share
    given = step_passes_kernel.fastest(pose, elapsed, moved)
    for one, other in zip(given, step_passes.fastest(pose, elapsed, moved), strict=True):
        assert_same(one, other)
    assert share or 2 not in given[1]


def test_the_imbalance_of_momentum(draw: Draw) -> None:
    rows = MomentumRows(
        momentum=(draw(STATES), draw(STATES), draw(STATES)),
        kinetic=np.abs(draw(STATES)),
        mass=np.abs(draw(STATES)),
        gravity=np.array([0.1, -0.2, -9.81]),
        forces=draw(STATES, 3),
        others=draw(STATES, 3),
        outer=draw(STATES, 3),
        size=np.abs(draw(STATES)),
        elapsed=np.full(STATES - 1, 1.0 / 240.0),
    )
    assert_same(step_passes_kernel.imbalance(rows), step_passes.imbalance(rows))


def test_a_step_that_nothing_changes_is_balanced() -> None:
    """No momentum, no mass, no cause: 0 over 0 is no imbalance."""
    none, vectors = np.zeros(5), np.zeros((5, 3))
    rows = MomentumRows(
        *((none,) * 3, none, none, np.zeros(3), vectors, vectors, vectors, none, np.ones(4))
    )
    assert_same(step_passes_kernel.imbalance(rows), none)
    assert_same(step_passes.imbalance(rows), none)


@pytest.mark.parametrize("cuts", [[], [1], [100, 101, 350]])
def test_energy_created(draw: Draw, cuts: list[int]) -> None:
    """In sections, too: what runs on from one to the next is the same."""
    rows = EnergyRows(*(draw(STATES) for _ in EnergyRows._fields))
    so_far, of_kernel = np.zeros(SO_FAR), np.zeros(SO_FAR)
    so_far[LOWEST] = of_kernel[LOWEST] = np.inf
    for begin, end in zip([0, *cuts], [*cuts, STATES], strict=True):
        part = EnergyRows(*(column[begin:end] for column in rows))
        found = step_passes_kernel.created(part, of_kernel)
        assert_same(found, step_passes.created(part, so_far))
        assert_same(of_kernel, so_far)
