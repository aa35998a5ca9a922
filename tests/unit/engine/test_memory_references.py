"""Memory that is handed on by where it lies is read and written as memory taken apart."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

if Kernel is None:
    pytest.skip("this numba compiles kernels whole", allow_module_level=True)

from lavendersim.engine.memory_references import are_rows, is_memory

ROW = np.dtype([("x", "f8"), ("n", "i8")], align=True)


class Inside(NamedTuple):
    """Memory within memory: of two dimensions, of none, of a slice."""

    square: np.ndarray
    nothing: Any
    column: np.ndarray
    numbers: np.ndarray


class Twice(NamedTuple):
    """Memory of one type."""

    first: np.ndarray
    second: np.ndarray


class Memory(NamedTuple):
    """What a kernel is given."""

    rows: np.ndarray
    inside: Inside
    twice: Twice


class Value(NamedTuple):
    """Memory with a number beside it, which kernels make."""

    numbers: np.ndarray
    count: int  # type: ignore[assignment]


def memory(rows: int = 4) -> Memory:
    """Return memory with something different at each place."""
    square = np.arange(12.0).reshape(3, 4)
    records = np.zeros(rows, ROW)
    records["x"], records["n"] = np.arange(rows) + 0.5, 10 * np.arange(rows)
    inside = Inside(square, (), square[:, 1], np.arange(5, dtype=np.int64) + 100)
    return Memory(
        records.view(np.recarray), inside, Twice(np.arange(3.0) - 7.0, np.arange(2.0) + 0.25)
    )


def add_up(numbers, count):
    total = 0.0
    for k in range(count):
        total += (k + 1) * numbers[k]
    return total


def make_walk(within: Any) -> Any:
    """Return a function that reads and writes everything, through others that it calls."""
    low = within(add_up)

    def change(inside, by):
        inside.square[2, 3] += by
        inside.column[0] -= by
        inside.numbers[-1] += 3
        return inside.numbers[len(inside.numbers) - 1] + low(inside.square[1], 4)

    changed = within(change)

    def of_value(value):
        return low(value.numbers, value.count)

    summed = within(of_value)

    def walk(memory, by):
        rows, inside, twice = memory
        found = changed(inside, by) + changed(memory.inside, 2.0 * by)
        for k in range(len(rows)):
            rows[k].x = rows[k].x * by + rows[k].n
        found += summed(Value(twice.first, len(twice.first))) + low(memory.twice.second, 2)
        twice[1][0] = found
        return found + rows.size + inside.square.shape[1] + len(inside.nothing)

    return within(walk)


def bytes_of(value: Any) -> bytes:
    if isinstance(value, tuple):
        return b"".join(map(bytes_of, value))
    return bytes(value.tobytes())


@pytest.mark.parametrize("rows", [0, 1, 4])
def test_all_of_it_is_read_and_written_where_it_lies(rows):
    ours, theirs = memory(rows), memory(rows)
    found, expected = make_walk(inner)(ours, 1.5), make_walk(lambda plain: plain)(theirs, 1.5)
    assert found == expected
    assert bytes_of(ours) == bytes_of(theirs)


def test_a_kernel_is_handed_one_address_for_all_of_it():
    """Beside it the place of what it returns, that of an exception, and the number."""
    parts = []

    def within(function: Any) -> Any:
        kernel = inner(function)
        parts.append(kernel)
        return kernel

    make_walk(within)(memory(), 1.5)
    (change,) = (part for part in parts if part.py_func.__name__ == "change")
    (linked,) = change.linked.values()
    (function,) = (
        each
        for each in linked.part._get_module_for_linking().functions
        if each.name == linked.part.symbol
    )
    assert len(list(function.arguments)) == 2 + 1 + 1


def test_what_is_memory_and_what_a_value():
    kinds = numba.typeof(memory())
    assert is_memory(kinds)
    assert all(is_memory(kinds.types[k]) for k in (1, 2))
    assert not is_memory(numba.typeof(Value(np.zeros(2), 1)))
    assert not is_memory(numba.typeof((np.zeros(2), np.zeros(2))))
    assert are_rows(kinds.types[0])
    assert not any(are_rows(kinds.types[1].types[k]) for k in (0, 2))


def test_arrays_are_not_handed_to_functions_of_numba():
    @numba.njit
    def foreign(numbers):
        return numbers[0]

    def caller(numbers):
        return foreign(numbers)

    with pytest.raises(NotImplementedError, match="foreign"):
        inner(caller)(np.zeros(2))
