"""Differences of columns, by their definitions on whole numbers of 64 bits in Python."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from interpreted import interpreted

from lavendersim.engine import difference_kernel as kernels
from lavendersim.engine.difference_kernel import (
    AFTER,
    COUNT,
    DELTA,
    GAP,
    LAW,
    LINEAR,
    PART,
    SAMPLE,
    SPHERES,
    TRIED,
    UNIT,
    XOR,
)
from lavendersim.engine.spec import Spec

MODULUS = 2**64


def folded(difference: int) -> int:
    """Return twice a number, or one less than twice its negative: 0, -1, 1, -2, ..."""
    signed = (difference + 2**63) % MODULUS - 2**63
    return 2 * signed if signed >= 0 else -2 * signed - 1


def expected_of(predictor: int, words: Any, rows: Any, hopes: Any) -> list[int]:
    """Return the differences of a column: rows that follow one of their key expect what it was."""
    persists, known = rows
    found = []
    for i, own in enumerate(int(word) for word in words):
        before = int(words[i - 1]) if persists[i] else 0
        goes_on = i > 1 and persists[i] and persists[i - 1]
        rise = int(words[i - 1]) - int(words[i - 2]) if goes_on else 0
        if predictor == XOR:
            found.append(own ^ before)
        elif predictor == DELTA:
            found.append(folded(own - before))
        elif predictor == LINEAR or (predictor == SPHERES and not known[i]):
            found.append(folded(own - before - rise))
        elif predictor in (AFTER, SPHERES):
            found.append(folded(own - int(hopes[i])))
        else:
            found.append(own ^ int(hopes[i]))
    return found


def column(rng: np.random.Generator, count: int) -> tuple[Any, Any, Any]:
    """Return words, rows and what is expected: of any bits, and of small steps either way."""
    words = rng.integers(0, MODULUS - 1, count, dtype=np.uint64)
    steps = rng.integers(-3, 4, count).cumsum().astype(np.uint64)
    words = np.where(rng.random(count) < 0.5, words, steps + np.uint64(2**40))
    persists = rng.random(count) < 0.7
    persists[0] = False
    hopes = words + rng.integers(0, 5, count, dtype=np.uint64)
    return words, (persists, rng.random(count) < 0.5), hopes


DIFFERENCES = interpreted(kernels._make_differences(Spec()))


@pytest.mark.parametrize("predictor", range(COUNT))
def test_every_predictor_leaves_what_its_definition_says(predictor: int, rng) -> None:
    """Whole, and in pieces that begin anywhere: the first two rows of all have nothing behind."""
    for count in (1, 2, 3, 40):
        words, rows, hopes = column(rng, count)
        expected = expected_of(predictor, words, rows, hopes)
        for cuts in ([0, count], [0, 1, count], sorted({0, min(2, count), count // 2, count})):
            for begin, end in pairwise(cuts):
                out = np.zeros(end - begin, np.uint64)
                with np.errstate(over="ignore"):
                    DIFFERENCES(predictor, words, rows, hopes, begin, out)
                assert out.tolist() == expected[begin:end], (count, begin)


def test_a_difference_of_either_sign_begins_with_zeros() -> None:
    fold = kernels._fold
    with np.errstate(over="ignore"):
        found = [int(fold(np.uint64(k % MODULUS))) for k in (0, -1, 1, -2, 2, 2**63, 2**63 - 1)]
    assert found == [0, 1, 2, 3, 4, MODULUS - 1, MODULUS - 2]
    assert found == [folded(k) for k in (0, -1, 1, -2, 2, 2**63, 2**63 - 1)]


def test_bytes_are_counted_from_the_first_that_is_not_0() -> None:
    for k in range(8):
        for word in (1 << 8 * k, (1 << 8 * k + 8) - 1):
            assert int(kernels._bytes_of(np.uint64(word))) == k + 1
    assert int(kernels._bytes_of(np.uint64(0))) == 0


PACK = interpreted(kernels._make_pack(Spec()))


def packed(words: Any, rows: Any, special: list[int], hopes: Any) -> tuple[list[int], np.ndarray]:
    """Return predictors and differences of columns, whose planes are the heaviest byte first."""
    columns, count = words.shape
    chosen, planes = np.zeros(columns, np.int64), np.zeros((8, columns, count), np.uint8)
    room = chosen, planes, np.zeros(PART, np.uint64)
    with np.errstate(over="ignore"):
        PACK(words, rows, np.array(special), hopes, np.zeros(COUNT, np.int64), room)
    shifts = 8 * np.arange(7, -1, -1, dtype=np.uint64)[:, None, None]
    return chosen.tolist(), (planes.astype(np.uint64) << shifts).sum(axis=0, dtype=np.uint64)


def sizes_of(words: Any, rows: Any, hopes: Any, special: int) -> dict[int, int]:
    """Return how many bytes a column takes by each predictor that it may have, of rows tried."""
    found = {}
    for predictor in (XOR, DELTA, LINEAR, *([special] if special > LINEAR else [])):
        total = 0
        for begin in range(0, len(words), TRIED * SAMPLE):
            part = slice(begin, begin + TRIED)
            own = tuple(row[part] for row in rows)
            left = expected_of(predictor, words[part], own, hopes[part])
            total += sum((left[i].bit_length() + 7) // 8 for i in range(1, len(left)) if own[0][i])
        found[predictor] = total
    return found


def test_the_predictor_that_leaves_least_is_taken_and_its_planes_are_written(rng) -> None:
    """Of one column each that noise, a step, a line and what is expected describe best."""
    count = 300
    persists = np.ones(count, bool)
    persists[0] = False
    rows, line = (persists, np.zeros(count, bool)), np.arange(count, dtype=np.uint64)
    jitter = rng.integers(0, 2, count, dtype=np.uint64)
    words = np.array(
        [
            np.uint64(1) << rng.integers(56, 64, count, dtype=np.uint64),
            np.uint64(2**40) + jitter * np.uint64(2**8 - 1) + jitter.cumsum().astype(np.uint64),
            line * line * np.uint64(3) + line * np.uint64(2**33),
            rng.integers(0, MODULUS - 1, count, dtype=np.uint64),
        ]
    )
    hopes = np.array([words[3] + np.uint64(1), np.zeros(count, np.uint64)])
    special = [0, 0, 0, AFTER]
    chosen, differences = packed(words, rows, special, hopes)
    for j in range(4):
        by_size = sizes_of(words[j], rows, hopes[0], special[j])
        least = min(by_size.values())
        assert chosen[j] == min(k for k, size in by_size.items() if size == least)
        assert differences[j].tolist() == expected_of(chosen[j], words[j], rows, hopes[0])
    assert chosen[2:] == [LINEAR, AFTER]


def test_a_special_predictor_is_tried_where_a_column_has_it_and_no_other(rng) -> None:
    """Each column with one takes the next of what is expected."""
    count = 64
    persists = np.ones(count, bool)
    persists[0] = False
    rows = persists, np.ones(count, bool)
    words = rng.integers(0, MODULUS - 1, (5, count), dtype=np.uint64)
    special = [0, UNIT, GAP, LAW, SPHERES]
    hopes = np.array([*words[1:], np.zeros(count, np.uint64)])
    chosen, differences = packed(words, rows, special, hopes)
    assert chosen[1:] == special[1:]
    assert not differences[1:].any()
    assert chosen[0] < UNIT


def test_columns_longer_than_a_part_are_packed_as_one(rng) -> None:
    words, rows, hopes = column(rng, PART + 3)
    chosen, differences = packed(words[None], rows, [0], hopes[None])
    assert differences[0].tolist() == expected_of(chosen[0], words, rows, hopes)


def test_rows_are_gathered_from_the_part_they_stand_in() -> None:
    """Of an order over all, those rows that this part has; others are left as they are."""
    gather = interpreted(kernels._make_gather(Spec()))
    rows = np.arange(12, dtype=np.uint64).reshape(4, 3)  # rows 10 to 13 of all
    order, columns = np.array([13, 9, 10, 14, 12]), np.array([2, 0])
    words = np.full((2, 5), 77, np.uint64)
    gather(rows, 10, order, columns, words)
    assert words.tolist() == [[11, 77, 2, 77, 8], [9, 77, 0, 77, 6]]
