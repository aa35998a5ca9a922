"""No garbage is looked for inside, and afterwards it is as before, whatever happened."""

from __future__ import annotations

import gc
import weakref

import pytest

from lavendersim.garbage import MANY, collect_recent, uncollected


def test_none_is_looked_for_inside_and_again_afterwards() -> None:
    assert gc.isenabled()
    with uncollected():
        assert not gc.isenabled()
        with uncollected():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()


def test_an_error_inside_leaves_it_as_before() -> None:
    with pytest.raises(KeyError), uncollected():
        raise KeyError
    assert gc.isenabled()


def test_who_looks_for_none_is_left_at_that() -> None:
    gc.disable()
    try:
        with uncollected():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


class _Ring:
    def __init__(self) -> None:
        self.itself = self


def _many_rings() -> weakref.ref[_Ring]:
    rings = [_Ring() for _ in range(2 * MANY)]
    return weakref.ref(rings[0])


def test_recent_garbage_is_found_inside_where_it_is_much() -> None:
    with uncollected():
        gc.collect(0)
        few = weakref.ref(_Ring())
        collect_recent()
        assert few() is not None
        many = _many_rings()
        assert many() is not None
        collect_recent()
        assert many() is None


def test_none_is_found_for_who_looks_for_none() -> None:
    gc.disable()
    try:
        with uncollected():
            many = _many_rings()
            collect_recent()
            assert many() is not None
    finally:
        gc.enable()
