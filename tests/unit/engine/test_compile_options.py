"""The name of a build follows whatever changes machine code, and nothing else."""

from __future__ import annotations

import numba
import pytest

from lavendersim.engine import compile_options
from lavendersim.engine.compile_options import OPTIONS, UNDOCUMENTED, build, known


def test_options_that_numba_does_not_know_are_left_out() -> None:
    class Older:
        fastmath = None

    options = {"fastmath": False, "nogil": True, **dict.fromkeys(UNDOCUMENTED, False)}
    assert known(options, Older) == {"fastmath": False, "nogil": True}
    assert known(options) == options


def test_results_depend_on_no_optimisers_mood_and_no_kernel_raises() -> None:
    assert OPTIONS["fastmath"] is False
    assert OPTIONS["error_model"] == "numpy"
    assert OPTIONS["nogil"] is True

    @numba.njit(**OPTIONS)
    def divide(a, b):
        return a / b

    assert divide(1.0, 0.0) == float("inf")


def test_a_build_is_the_same_until_something_it_depends_on_changes(monkeypatch) -> None:
    name = build()
    assert len(name) == 8
    assert build() == name
    monkeypatch.setenv("UNRELATED_TO_THE_COMPILER", "1")
    assert build() == name
    monkeypatch.setenv("NUMBA_WHATEVER", "1")
    assert build() != name


@pytest.mark.parametrize("setting", ["OPT", "LOOP_VECTORIZE", "DEBUGINFO_DEFAULT"])
def test_every_setting_of_the_compiler_has_its_part(setting: str, monkeypatch) -> None:
    name = build()
    monkeypatch.setattr(numba.config, setting, "something else")
    assert build() != name


def test_options_processor_and_sources_have_theirs(monkeypatch) -> None:
    name = build()
    with monkeypatch.context() as patch:
        patch.setitem(OPTIONS, "nogil", False)
        assert build() != name
    for part in ("_processor", "_compiler_hash", "_llvmlite"):
        with monkeypatch.context() as patch:
            patch.setattr(compile_options, part, lambda: "another")
            assert build() != name
    assert build() == name
