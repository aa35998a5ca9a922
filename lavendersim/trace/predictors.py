"""Predictive coding of contact columns: what each number is expected to be, from known ones.

A column of numbers is taken as its bits, contacts of one key (`contact_columns`) one after the
other. What is stored is how each differs from what its predictor says, which compresses well; a
kernel of the engine writes that (`engine.difference_kernel`), and here is the inverse. All of it is
integer arithmetic modulo 2^64, or operations that IEEE 754 rounds in one way alone:
logs are read on any machine.

    0  the contact before of the same key, differences by xor
    1  the contact before, differences by subtraction
    2  the straight line through the two before
    3  of nz: sqrt(1 - nx^2 - ny^2), by xor, so that the sign is a bit of it
    4  of the velocity before the solve: that of the contact before, after its solve
    5  of the target: that of a gap beyond the slop, to be closed within the timestep; by xor
    6  of the residual: Signorini's and Coulomb's natural maps of the row, by xor (see there)
    7  of point, normal and separation: those of two spheres, and of a plane and a sphere, where
       these are at the start of the step (`sphere_contacts`), by subtraction; of others as 2

Differences by subtraction have their sign in the lowest bit: small ones of either sign begin with
zeros.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]
Floats = NDArray[np.float64]
COUNT: Final = 8
XOR, DELTA, LINEAR, UNIT, AFTER, GAP, LAW, SPHERES = range(COUNT)
ALONE: Final = (XOR, DELTA, LINEAR)  # need no other column
# Of these columns what is expected follows from others, here in the order in which they are read.
SPECIAL: Final[dict[str, tuple[int, tuple[str, ...]]]] = {
    "nz": (UNIT, ("nx", "ny")),
    "approach_velocity": (AFTER, ("normal_velocity",)),
    "target": (GAP, ("separation",)),
    "residual": (
        LAW,
        (
            *("target", "normal_velocity", "impulse_n", "inverse_effective_mass", "friction"),
            *("impulse_t1", "impulse_t2", "slip_t1", "slip_t2"),
        ),
    ),
}
# Along a tangent two balls move that much more easily than along the normal, and a ball on what
# does not move: 1 + 5/2. The residual of other shapes is expected less well.
TANGENTIAL: Final = 3.5
# Rows at a time: what is computed of them stays in the processor's cache.
PART: Final = 4096
_ONE: Final = np.uint64(1)


class Constants(NamedTuple):
    """What is expected by, beside the columns: of the first step of a group."""

    timestep: float = 0.0  # [s]
    slop: float = 0.0  # [m]


class Keys(NamedTuple):
    """Rows in the order of their keys: where each key begins."""

    persists: NDArray[np.bool_]  # whether a row follows one of its key, (n,)
    begin: NDArray[np.intp]  # the first row of its key, (n,)


def keys_of(persists: NDArray[np.bool_]) -> Keys:
    """Return where keys begin."""
    count = len(persists)
    return Keys(persists, np.maximum.accumulate(np.where(persists, 0, np.arange(count))))


def numbers(predictor: int, stored: Words, expected: Words | None, keys: Keys) -> Words:
    """Return a column from what is stored of it; expected: of predictors that need others."""
    if expected is not None:
        by_subtraction = predictor in (AFTER, SPHERES)
        return expected + _unfolded(stored) if by_subtraction else stored ^ expected
    if predictor == XOR:
        running = np.bitwise_xor.accumulate(stored)
        return running ^ _before(running, keys)
    found = _unfolded(stored)
    if predictor == LINEAR:
        rises = np.where(keys.persists, found, np.uint64(0)).cumsum(dtype=np.uint64)
        rises -= rises[keys.begin]
        found = np.where(keys.persists, rises, found)
    running = found.cumsum(dtype=np.uint64)
    return running - _before(running, keys)


def _before(running: Words, keys: Keys) -> Words:
    """Return what ran up before each key began."""
    return np.where(keys.begin > 0, running[keys.begin - 1], np.uint64(0))


def expected(
    predictor: int, columns: Mapping[str, Words], persists: NDArray[np.bool_], constants: Constants
) -> Words:
    """Return what is expected of a column that follows from others; all in the order of keys."""
    if predictor == AFTER:
        return _shifted(columns["normal_velocity"], persists)
    found = np.empty(len(persists))
    with np.errstate(all="ignore"):
        floats = {name: words.view(np.float64) for name, words in columns.items()}
        for begin in range(0, len(found), PART):
            part = slice(begin, begin + PART)
            found[part] = _expected(
                predictor, {name: numbers[part] for name, numbers in floats.items()}, constants
            )
    return found.view(np.uint64)


def expect(
    predictor: int,
    rows: tuple[Words, NDArray[np.int64], NDArray[np.bool_]],
    constants: Constants,
    out: Words,
) -> None:
    """Write the same into `out`, by a kernel.

    rows: columns (m, n) in the order of keys; which of them the predictor needs, in the order of
    SPECIAL; and whether each row follows one of its key.
    """
    from lavendersim.engine.expected_kernel import expect_numbers  # late: numba

    words, sources, persists = rows
    if predictor == AFTER:
        out[:1] = 0
        np.multiply(words[sources[0], :-1], persists[1:], out=out[1:])
    elif expect_numbers()(
        predictor, words.view(np.float64), sources, tuple(constants), out.view(np.float64)
    ):  # what is no number has the bits that a reader finds
        names = next(names for code, names in SPECIAL.values() if code == predictor)
        named = {name: words[source] for name, source in zip(names, sources, strict=True)}
        out[:] = expected(predictor, named, persists, constants)


def _expected(predictor: int, of: Mapping[str, Floats], constants: Constants) -> Floats:
    if predictor == UNIT:
        return _unit(of["nx"], of["ny"])
    if predictor == GAP:
        gap = of["separation"] - constants.slop
        return np.where(gap > 0.0, gap / constants.timestep, 0.0)
    return _law(of)


def _shifted(column: Words, persists: NDArray[np.bool_]) -> Words:
    """Return the number of the contact before of the same key, 0 where there is none."""
    before = np.zeros_like(column)
    before[1:] = np.where(persists[1:], column[:-1], np.uint64(0))
    return before


def _unit(x: Floats, y: Floats) -> Floats:
    """Return the third component of unit vectors, 0 where the others are too long, or no number."""
    left = 1.0 - x * x - y * y
    return np.sqrt(np.where(left >= 0.0, left, 0.0))


def _law(of: Mapping[str, Floats]) -> Floats:
    """Return the residual of rows, in the order of operations of `engine.residual`."""
    k_n, impulse_n = of["inverse_effective_mass"], of["impulse_n"]
    normal = np.abs(np.minimum(of["normal_velocity"] + of["target"], impulse_n / (1.0 / k_n)))
    k_t = TANGENTIAL * k_n
    scaled_1, scaled_2 = k_t * of["impulse_t1"], k_t * of["impulse_t2"]
    limit = k_t * of["friction"] * impulse_n
    one, two = scaled_1 - of["slip_t1"], scaled_2 - of["slip_t2"]
    squared = one * one + two * two
    slides = squared > limit * limit
    scale = limit / np.sqrt(squared)
    one = np.where(slides, one * scale, one) - scaled_1
    two = np.where(slides, two * scale, two) - scaled_2
    tangential = np.sqrt(one * one + two * two)
    return np.where(tangential > normal, tangential, normal)


def _unfolded(stored: Words) -> Words:
    return (stored >> _ONE) ^ (np.uint64(0) - (stored & _ONE))
