"""Kernels are compiled in parts, once each, and do what plain functions do, to the bit."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from numba import float64, int64, njit
from numba.core.errors import TypingError

from lavendersim.engine.compile import Kernel, inner
from lavendersim.engine.kernel_parts import STORE
from tests.forked_python import python as forked_python

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def square_plus(x, y):
    return x * x + y


def make_polynomial(square: Any, offset: float) -> Any:
    def polynomial(x):
        total = 0.0
        for k in range(3):
            total += square(x, offset + k)
        return total

    return inner(polynomial)


@pytest.fixture(autouse=True)
def anew() -> Any:
    """Nothing that another process compiled is taken."""
    STORE.begin(anew=True)
    yield
    STORE.begin(anew=False)


def test_a_kernel_does_what_the_function_does() -> None:
    kernel = make_polynomial(inner(square_plus), 0.1)
    for x in (0.3, -7.0, np.inf):
        plain = sum((x * x + (0.1 + k) for k in range(3)), 0.0)
        assert kernel(x) == plain


def test_a_part_is_linked_once_a_signature_and_python_gets_no_door() -> None:
    """What kernels call has code for them alone; called from Python it is compiled once more."""
    square = inner(square_plus)
    kernels = [make_polynomial(square, offset) for offset in (0.1, 0.2)]
    for kernel in kernels:
        kernel(1.5)
        assert kernel.has_door((float64,))
    assert list(square.linked) == [(float64, float64)]
    assert not square.has_door((float64, float64))
    (linked,) = square.linked.values()
    assert f"square_plus_{linked.part.key}" in linked.part.symbol
    assert linked.signature.return_type == float64
    assert not linked.part.raises
    assert square(2.0, 1.0) == 5.0
    assert square.has_door((float64, float64))


def test_kernels_of_other_types_have_parts_of_their_own() -> None:
    square = inner(square_plus)

    def caller(a, b):
        return square(a, a) + square(b, b)

    assert inner(caller)(3, 0.5) == 12.75
    assert set(square.linked) == {(int64, int64), (float64, float64)}
    parts = [linked.part for linked in square.linked.values()]
    assert len({part.key for part in parts}) == len({part.symbol for part in parts}) == 2


def test_a_part_that_was_compiled_is_found_by_an_equal_kernel() -> None:
    """Another object of the same code has its part, and one of another constant its own."""
    first, again = inner(square_plus), inner(square_plus)
    for square in (first, again):
        make_polynomial(square, 0.1)(1.0)
    (one,), (other,) = first.linked.values(), again.linked.values()
    assert one.part is other.part
    polynomials = [make_polynomial(first, offset) for offset in (0.1, 0.2)]

    def caller(x):
        return inner_one(x) - inner_two(x)

    inner_one, inner_two = polynomials
    difference = inner(caller)(2.0)
    assert difference == polynomials[0].py_func(2.0) - polynomials[1].py_func(2.0)
    keys = {linked.part.key for each in polynomials for linked in each.linked.values()}
    assert len(keys) == 2


def make_call(called: Any) -> Any:
    def call(a, b):
        return called(a, b)

    return inner(call)


def test_only_a_part_that_may_raise_says_so() -> None:
    def divide(x, y):
        if y == 0:
            raise ValueError
        return x // y

    def at(rows, k):
        return rows[k]

    parts = {}
    for function, arguments in ((divide, (7, 2)), (at, (np.ones(3), 1))):
        kernel = inner(function)
        assert make_call(kernel)(*arguments) == function(*arguments)
        (linked,) = kernel.linked.values()
        parts[function] = linked.part.raises
    assert parts == {divide: True, at: False}


def test_records_and_tuples_go_through_parts() -> None:
    """Fields are read and written where they stand, and tuples come back whole."""
    row = np.dtype([("x", "f8"), ("count", "i8")], align=True)

    def step(record, dx):
        record.x += dx
        record.count += 1
        return record.x, record.count

    stepped = inner(step)

    def whole(rows, dx):
        total = 0.0
        for i in range(rows.shape[0]):
            x, count = stepped(rows[i], dx)
            total += x * count
        return total

    rows, twin = (np.zeros(3, row).view(np.recarray) for _ in range(2))
    assert inner(whole)(rows, 0.25) == njit(whole_of(njit(step)))(twin, 0.25)
    assert rows.tobytes() == twin.tobytes()
    assert rows.x.tolist() == [0.25] * 3


def whole_of(stepped: Any) -> Any:
    def whole(rows, dx):
        total = 0.0
        for i in range(rows.shape[0]):
            x, count = stepped(rows[i], dx)
            total += x * count
        return total

    return whole


def test_code_of_one_kernel_may_be_in_a_process_twice() -> None:
    """Loaded and compiled, or compiled for two engines: each has a name of its own."""
    first, second = (make_polynomial(inner(square_plus), 0.1) for _ in range(2))
    assert first(2.0) == second(2.0) == first(2.0)


def test_an_error_in_a_part_says_where_it_is() -> None:
    def adds_a_text(x):
        return x + "text"

    part = inner(adds_a_text)

    def caller(x):
        return part(x)

    with pytest.raises(TypingError, match=r"test_part_compiler.py.*\n.*adds_a_text"):
        inner(caller)(1.0)


# Calls a kernel, then composes another that counts references where the first one did not.
BOTH_KINDS = """
import numpy as np
from lavendersim.engine import compile_options
from lavendersim.engine.compile import inner
def total(rows):
    found = 0.0
    for i in range(rows.shape[0]):
        found += rows[i]
    return found
part = inner(total)
def caller(rows):
    return part(rows)
options = compile_options.OPTIONS
if COUNTING_FIRST:
    without = options.pop("_nrt")
    part = inner(total)
print(inner(caller)(np.ones(3)))
options["_nrt"] = not options.get("_nrt", True)
try:
    inner(caller)(np.ones(3))
except RuntimeError as error:
    print(error)
else:
    print("not refused")
"""


def test_sixty_parts_in_a_row_are_compiled_each_inside_of_its_caller() -> None:
    """Python lets a thousand calls nest, which are some forty parts."""

    def begin(x):
        return x + 1.0

    def calling(part):
        def one_more(x):
            return part(x) + 1.0

        return inner(one_more)

    part, before = inner(begin), sys.getrecursionlimit()
    for _ in range(59):
        part = calling(part)
    assert calling(part)(0.5) == 61.5
    assert sys.getrecursionlimit() == before


@pytest.mark.parametrize(("first", "does", "do"), [(0, "does", "do not"), (1, "does not", "do")])
def test_kernels_that_count_references_do_not_meet_others(first: int, does: str, do: str) -> None:
    """They hand arrays to each other in other forms: a process that has both would crash."""
    done = forked_python("-c", BOTH_KINDS.replace("COUNTING_FIRST", str(first)))
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        "3.0",
        f"kernel caller {does} count references or explain itself to a debugger, and those "
        f"compiled before {do}: a process has one kind of kernels",
    ]
