"""Which functions of a module are merged into their callers: what is called once or short."""

from __future__ import annotations

import pytest

from lavendersim.engine import optimisation
from lavendersim.engine.optimisation import merged_in

SHORT = 10


def function(name: str, lines: int, *called: str) -> str:
    """Return LLVM's text of a function of so many lines, some of which are calls."""
    calls = [f'  %{k} = call i32 @"{other}"(i64 0)' for k, other in enumerate(called)]
    rest = ["  fence seq_cst"] * (lines - len(calls))
    return "\n".join([f'define i32 @"{name}"(i64 %a) {{', *calls, *rest, "}", ""])


def merged(*functions: str) -> set[str]:
    names = {text.split('"')[1] for text in functions}
    return merged_in("\n".join(functions), names - {"step"}, SHORT)


def test_what_is_called_once_or_short_is_merged_and_nothing_else() -> None:
    step = function("step", 30, "once", "short", "short", "long", "long")
    assert merged(
        step, function("once", 50), function("short", SHORT - 1), function("long", SHORT)
    ) == {"once", "short"}


def test_what_is_long_in_a_short_function_stays_a_function(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solve of few lines, called from two places, would bring all of its solver to both."""
    step = function("step", 30, "solve", "solve")
    solve, solver = function("solve", SHORT - 1, "solver", "check"), function("solver", 50)
    functions = step, solve, solver, function("check", 20)
    assert merged(*functions) == {"solve", "solver", "check"}
    monkeypatch.setattr(optimisation, "MOST", 50)
    assert merged(*functions) == {"solve", "check"}  # 9 + 20 lines
    monkeypatch.setattr(optimisation, "MOST", 9)
    assert merged(*functions) == set()


def test_lines_are_those_of_all_that_is_merged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Short functions, each called twice by the one before, are many copies in the end."""
    levels = [function(f"f{k}", 9, f"f{k + 1}", f"f{k + 1}") for k in range(4)]
    functions = function("step", 30, "f0", "f0"), *levels, function("f4", 9)
    monkeypatch.setattr(optimisation, "MOST", 100)
    # 9, 9 + 2 * 9 = 27, 9 + 2 * 27 = 63, 9 + 2 * 63 = 135: that one is not merged, nor counted.
    assert merged(*functions) == {"f0", "f2", "f3", "f4"}


def test_a_function_that_calls_itself_is_not_looked_into_for_ever() -> None:
    assert merged(function("step", 30, "again"), function("again", 20, "again")) == set()
