"""The least and the greatest of a few numbers are Python's, whatever is no number or zero."""

import itertools
from inspect import signature

import numpy as np
import pytest

from lavendersim.engine.compile import Kernel, inner

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")
FLOATS = 0.0, -0.0, 1.5, -np.inf, np.nan


def two(x, y):
    return min(x, y), max(x, y), max(x, 0.5), min(0.5, x)


def three(x, y, z):
    return min(x, y, z), max(x, y, z), max(min(x, y), z)


def whole(i, j):
    return min(i, j), max(i, j), max(i, 3), min(2, j), max(i, j, 1)


def mixed(x, i):
    return max(x, i), min(i, x)


@pytest.mark.parametrize("function", [two, three])
def test_floats(function):
    kernel, names = inner(function), signature(function).parameters
    for values in itertools.product(FLOATS, repeat=len(names)):
        expected = np.array(function(*values))
        assert np.array(kernel(*values)).tobytes() == expected.tobytes(), values


def test_whole_numbers():
    kernel = inner(whole)
    for values in itertools.product((-(2**63), -1, 2, 2**62), repeat=2):
        assert kernel(*values) == whole(*values)


def test_numbers_of_two_types_are_left_to_numba():
    assert inner(mixed)(2.5, 3) == (3.0, 2.5)
