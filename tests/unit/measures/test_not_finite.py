"""A decorated function lets infinities through without numpy's warnings."""

from __future__ import annotations

import warnings

import numpy as np

from lavendersim.measures.not_finite import without_warnings


@without_warnings
def difference(one: np.ndarray, *, other: np.ndarray) -> np.ndarray:
    """Return the difference."""
    return one - other


def test_infinities_come_out_as_they_are_without_a_warning() -> None:
    infinite = np.array([np.inf, 1e308])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = difference(infinite, other=np.array([np.inf, -1e308]))
    assert np.isnan(found[0])
    assert found[1] == np.inf


def test_the_function_keeps_its_name_and_numpy_its_settings() -> None:
    assert difference.__name__ == "difference"
    with np.errstate(over="raise"):
        before = np.geterr()
        difference(np.array([1.0]), other=np.array([1.0]))
        assert np.geterr() == before
