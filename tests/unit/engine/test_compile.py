"""A kernel has a door to Python where Python calls it, and is right behind every door."""

from __future__ import annotations

import gc
from typing import Any

import numpy as np
import pytest
from numba import int64, njit
from numba.core.errors import TypingError

from lavendersim.engine.compile import (
    compiling,
    composing,
    either,
    greatest,
    inner,
    kernel,
    naming,
    once,
    separate,
)
from lavendersim.engine.kernel_parts import STORE
from lavendersim.engine.spec import Spec


def chain_of_two():
    """Return two kernels, of which the second calls the first."""

    @inner
    def square(x):
        return x * x

    @inner
    def square_plus_one(x):
        return square(x) + 1

    return square, square_plus_one


def test_what_only_a_kernel_calls_has_no_door() -> None:
    square, square_plus_one = chain_of_two()
    assert square_plus_one(3) == 10
    assert square_plus_one.has_door((int64,))
    assert not square.has_door((int64,))


def test_python_may_call_it_afterwards() -> None:
    square, square_plus_one = chain_of_two()
    assert square_plus_one(3) == 10
    assert square(5) == 25
    assert square.has_door((int64,))
    assert square_plus_one(4) == 17


def test_python_may_call_it_first() -> None:
    square, square_plus_one = chain_of_two()
    assert square(5) == 25
    assert square_plus_one(3) == 10
    assert square.has_door((int64,))


def test_each_signature_has_its_own_door() -> None:
    square, square_plus_one = chain_of_two()
    assert square_plus_one(3) == 10
    assert square(1.5) == 2.25
    assert not square.has_door((int64,))
    assert square(3) == 9


def test_a_kernel_compiled_later_finds_what_was_compiled_twice() -> None:
    square, square_plus_one = chain_of_two()
    square_plus_one(3)
    square(3)

    @inner
    def fourth_power(x):
        return square(square(x))

    assert fourth_power(3) == 81


def test_a_part_that_was_compiled_twice_is_linked_once() -> None:
    """The first caller holds what was compiled first, and both end in one kernel."""
    _, square_plus_one = chain_of_two()

    @inner
    def before(x):
        return square_plus_one(x)

    assert before(3) == 10
    STORE.begin(anew=True)
    again, _ = chain_of_two()

    @inner
    def once_more(x):
        return again(x)

    assert once_more(3) == 9
    STORE.begin(anew=False)

    @inner
    def all_of_it(x):
        return before(x) + once_more(x)

    assert all_of_it(3) == 19


def test_the_collector_is_back_after_a_compilation_that_failed() -> None:
    @inner
    def wrong(x):
        return x + "a"

    resting = []

    def attempt() -> None:
        with compiling():
            resting.append(not gc.isenabled())
            wrong(1)

    assert gc.isenabled()
    with pytest.raises(TypingError):
        attempt()
    assert resting == [True]
    assert gc.isenabled()


def test_one_part_serves_records_of_two_layouts_in_one_kernel() -> None:
    """Both have `x` at the same place: to the part they look the same."""

    @inner
    def doubled(row):
        return 2.0 * row.x

    @inner
    def sum_of_both(short, long):
        return doubled(short[0]) + doubled(long[0])

    short = np.array([(1.5,)], [("x", "f8")])
    long = np.array([(3.0, 7.0)], [("x", "f8"), ("y", "f8")])
    with compiling():
        assert sum_of_both(short, long) == 9.0


def test_numba_s_own_function_may_call_a_kernel() -> None:
    _, square_plus_one = chain_of_two()

    @njit
    def twice(x):
        return 2 * square_plus_one(x)

    assert twice(3) == 20


def test_kernels_that_are_named_alone_are_plain_functions_and_are_given_to_nobody_else() -> None:
    def one(x):
        return x

    @once
    def make(spec: Spec) -> Any:
        return separate(kernel(one, spec), spec)

    spec = Spec(shape_pairs=("box_box",))
    with naming() as first:
        assert make(spec) is one
        assert not hasattr(one, "separate")
    with naming() as again:  # made before: listed all the same
        make(spec)
    assert first == again == [(one.__module__, "one")]
    with composing() as composed:  # a kernel, though its name was asked for before
        assert make(spec).py_func is one
    assert composed == first
    with naming():
        assert make(spec) is one


@pytest.mark.parametrize("numbers", [(3.0,), (1.0, 2.0), (-1.0, -5.0, -2.0)])
def test_kernels_of_several_effects_answer_together(numbers: tuple[float, ...]) -> None:
    def constant(number: float) -> Any:
        def scaled_by(x):
            return number * x

        return kernel(scaled_by, Spec())

    def above(number: float) -> Any:
        def is_above(x):
            return number > x

        return kernel(is_above, Spec())

    with compiling():
        assert greatest([constant(n) for n in numbers], Spec())(2.0) == 2.0 * max(numbers)
        for bound in (-10.0, -1.5, 1.5, 10.0):
            assert either([above(n) for n in numbers], Spec())(bound) == (max(numbers) > bound)
