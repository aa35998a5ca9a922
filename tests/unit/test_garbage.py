"""No garbage is looked for inside, and afterwards it is as before, whatever happened."""

from __future__ import annotations

import gc

import pytest

from lavendersim.garbage import uncollected


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
