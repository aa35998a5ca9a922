"""What kernels expect of numbers is what the reader's formulas expect, bit for bit.

The formulas (`trace.predictors`, `trace.sphere_contacts`) are written on whole columns in numpy: an
independent second program of the same operations, and the one that gives the numbers back.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from interpreted import interpreted

from lavendersim.engine import expected_kernel as kernels
from lavendersim.engine.difference_kernel import GAP, LAW, UNIT
from lavendersim.engine.spec import Spec
from lavendersim.trace.predictors import SPECIAL, TANGENTIAL, Constants, expected
from lavendersim.trace.sphere_contacts import (
    COLUMNS,
    FIELDS,
    NORMAL,
    OFFSET,
    RADIUS,
    Starts,
    expected_contacts,
)

EXPECT = interpreted(kernels._make_expect(Spec()))
PLACE = interpreted(kernels._make_place(Spec()))
CONSTANTS = Constants(timestep=1.0 / 240.0, slop=1e-7)
COUNT = 200


def sources_of(predictor: int) -> tuple[str, ...]:
    return next(names for code, names in SPECIAL.values() if code == predictor)


def columns_of(predictor: int, rng: np.random.Generator) -> np.ndarray:
    """Return the columns that a predictor needs: of the size that a log has, and zeros of a sign.

    Rows that slide, that stick, and such that press on nothing.
    """
    numbers = rng.normal(size=(len(sources_of(predictor)), COUNT))
    numbers[rng.random(numbers.shape) < 0.1] = 0.0
    numbers[rng.random(numbers.shape) < 0.1] *= -1.0
    return numbers * 10.0 ** rng.integers(-3, 1, numbers.shape)


def expect(predictor: int, numbers: np.ndarray) -> tuple[np.ndarray, int]:
    """Return what the kernel expects; in another order than the columns stand in."""
    order = np.arange(len(numbers))[::-1].copy()
    out = np.zeros(numbers.shape[1])
    with np.errstate(all="ignore"):
        wrong = EXPECT(predictor, numbers[order], np.argsort(order), tuple(CONSTANTS), out)
    return out, wrong


def by_formula(predictor: int, numbers: np.ndarray) -> np.ndarray:
    named = dict(zip(sources_of(predictor), numbers.view(np.uint64), strict=True))
    return expected(predictor, named, np.zeros(numbers.shape[1], bool), CONSTANTS)


@pytest.mark.parametrize("predictor", [UNIT, GAP, LAW])
def test_a_number_is_expected_as_the_reader_expects_it(predictor: int, rng) -> None:
    numbers = columns_of(predictor, rng)
    mine, wrong = expect(predictor, numbers)
    theirs = by_formula(predictor, numbers).view(np.float64)
    finite = np.isfinite(theirs)
    assert wrong == np.isnan(theirs).sum()  # a row of no mass that presses on nothing: 0 / 0
    assert mine[finite].tobytes() == theirs[finite].tobytes()
    assert finite.sum() > COUNT // 2
    assert len(np.unique(mine[finite])) > COUNT // 8  # not of one branch alone


@pytest.mark.parametrize("predictor", [UNIT, GAP, LAW])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_whoever_asks_learns_of_what_is_no_number(predictor: int, bad: float, rng) -> None:
    """Each column in turn: what is a number in spite of it has the reader's bits, too."""
    for row in range(len(sources_of(predictor))):
        numbers = np.abs(columns_of(predictor, rng)) + 0.01
        numbers[row, :5] = bad
        mine, wrong = expect(predictor, numbers)
        theirs = by_formula(predictor, numbers).view(np.float64)
        assert wrong == np.isnan(theirs).sum()
        kept = ~np.isnan(theirs)
        assert mine[kept].tobytes() == theirs[kept].tobytes()


def scene(rng: np.random.Generator) -> tuple[Any, Starts]:
    """Return keys of contacts of any two of some bodies, and these where they stand.

    Two spheres, a plane, a body of another shape; places that are no numbers, and two at one place.
    """
    bodies = np.zeros((4, FIELDS))
    bodies[0, NORMAL], bodies[0, OFFSET] = [0.48, 0.6, 0.64], -0.3
    bodies[1:3, RADIUS] = 0.1, 0.25
    positions = rng.normal(size=(5, 4, 3))
    positions[2, 1] = np.nan
    positions[3, 1] = positions[3, 2]
    positions[4, 2] = np.inf
    keys = rng.integers(-1, 6, (3, COUNT))
    return keys, Starts(bodies, positions, np.sort(rng.integers(0, 5, COUNT)))


def test_contacts_of_spheres_are_where_the_closed_form_has_them(rng) -> None:
    keys, starts = scene(rng)
    order = rng.permutation(COUNT)
    table = np.full((len(COLUMNS) + 1, COUNT), np.nan)
    with np.errstate(all="ignore"):
        PLACE(keys, order, starts.step, starts.bodies, starts.positions, table)
    ordered = starts._replace(step=starts.step[order])
    theirs = expected_contacts(keys[0, order], keys[1, order], ordered)
    assert 0 < theirs.known.sum() < COUNT
    assert (table[-1] == theirs.known).all()
    for name, mine in zip(COLUMNS, table, strict=False):
        assert mine.tobytes() == theirs.columns[name].tobytes(), name


def test_constants_are_those_of_the_reader() -> None:
    assert kernels.TANGENTIAL == TANGENTIAL
    assert (kernels.RADIUS, kernels.OFFSET) == (RADIUS, OFFSET)
    assert slice(kernels.NORMAL, kernels.NORMAL + 3) == NORMAL
