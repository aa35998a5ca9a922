"""Functions of a module that are called once, or are short, are merged into what calls them."""

from __future__ import annotations

import pytest
from llvmlite.binding import parse_assembly
from numba.core import config
from numba.core.registry import cpu_target

from lavendersim.engine import optimisation
from lavendersim.engine.compile import Kernel
from lavendersim.engine.optimisation import SELDOM_SHORT, SHORT, counted, merged_in, optimise

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def function(name: str, *, lines: int = 0, calls: tuple[str, ...] = ()) -> str:
    """Return a function of so many stores, which nothing may leave out, that calls others."""
    body = [f"  store volatile i64 {line}, ptr %p" for line in range(lines)]
    body += [f'  call void @"{called}"(ptr %p)' for called in calls]
    return "\n".join([f'define void @"{name}"(ptr %p) {{', *body, "  ret void", "}", ""])


def left(text: str, parts: set[str], short: int = SHORT) -> set[str]:
    """Return the functions that a module of this text has when it is optimised."""
    module = parse_assembly(text)
    optimise(module, parts, cpu_target.target_context.codegen(), short=short)
    module.verify()
    return {each.name for each in module.functions if not each.is_declaration}


@pytest.fixture(autouse=True)
def optimised_as_for_users(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(config, "OPT", config._OptLevel(3))  # type: ignore[attr-defined]


def test_calls_and_lengths_are_those_of_the_text():
    text = function("a.b", calls=("a long name", "plain", "plain"))
    text += function("plain", lines=3) + function("a long name")
    called, lengths = counted(str(parse_assembly(text)))
    assert called == {"a.b": {"plain": 2, "a long name": 1}, "plain": {}, "a long name": {}}
    # every block has its end, `ret`; no label is written where a function has one block
    assert lengths == {"a.b": 4, "plain": 4, "a long name": 1}


def test_what_is_called_once_is_merged_whatever_its_length():
    whole = function("whole", calls=("part",)) + function("part", lines=2 * SHORT)
    assert left(whole, {"part"}) == {"whole"}


@pytest.mark.parametrize(("lines", "merged"), [(SHORT // 2, True), (2 * SHORT, False)])
def test_what_is_called_twice_is_merged_where_it_is_short(lines: int, merged: bool):
    whole = function("whole", calls=("part", "part")) + function("part", lines=lines)
    assert left(whole, {"part"}) == ({"whole"} if merged else {"whole", "part"})


def test_into_what_is_seldom_called_less_is_merged():
    whole = function("whole", calls=("part", "part")) + function("part", lines=SHORT // 2)
    assert left(whole, {"part"}, SELDOM_SHORT) == {"whole", "part"}


SUM = """define void @whole(ptr noalias %a, ptr noalias %b, i64 %n) {
entry:
  br label %loop
loop:
  %i = phi i64 [0, %entry], [%next, %loop]
  %at = getelementptr double, ptr %a, i64 %i
  %of = getelementptr double, ptr %b, i64 %i
  %x = load double, ptr %at
  %y = load double, ptr %of
  %s = fadd double %x, %y
  store double %s, ptr %at
  %next = add nuw nsw i64 %i, 1
  %more = icmp ult i64 %next, %n
  br i1 %more, label %loop, label %end
end:
  ret void
}
"""


@pytest.mark.parametrize("vectors", [False, True])
def test_loops_are_of_vectors_where_a_part_says_so(vectors: bool):
    codegen = cpu_target.target_context.codegen()
    module = parse_assembly(SUM)
    module.data_layout = codegen._data_layout
    optimise(module, set(), codegen, vectors=vectors)
    assert ("x double>" in str(module)) == vectors


def test_what_others_may_call_stays():
    whole = function("whole", calls=("other",)) + function("other")
    assert left(whole, set()) == {"whole", "other"}


def test_without_optimisation_nothing_is_merged(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(config, "OPT", config._OptLevel(0))  # type: ignore[attr-defined]
    whole = function("whole", calls=("part",)) + function("part")
    assert left(whole, {"part"}) == {"whole", "part"}


FEW = 10


def lines_of(name: str, lines: int, *called: str) -> str:
    """Return LLVM's text of a function of so many lines, some of which are calls."""
    calls = [f'  %{k} = call i32 @"{other}"(i64 0)' for k, other in enumerate(called)]
    rest = ["  fence seq_cst"] * (lines - len(calls))
    return "\n".join([f'define i32 @"{name}"(i64 %a) {{', *calls, *rest, "}", ""])


def merged(*functions: str) -> set[str]:
    names = {text.split('"')[1] for text in functions}
    return merged_in("\n".join(functions), names - {"step"}, FEW)


def test_what_is_called_once_or_short_is_merged_and_nothing_else() -> None:
    step = lines_of("step", 30, "once", "short", "short", "long", "long")
    assert merged(
        step, lines_of("once", 50), lines_of("short", FEW - 1), lines_of("long", FEW)
    ) == {"once", "short"}


def test_what_is_long_in_a_short_function_stays_a_function(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solve of few lines, called from two places, would bring all of its solver to both."""
    step = lines_of("step", 30, "solve", "solve")
    solve, solver = lines_of("solve", FEW - 1, "solver", "check"), lines_of("solver", 50)
    functions = step, solve, solver, lines_of("check", 20)
    assert merged(*functions) == {"solve", "solver", "check"}
    monkeypatch.setattr(optimisation, "MOST", 50)
    assert merged(*functions) == {"solve", "check"}  # 9 + 20 lines
    monkeypatch.setattr(optimisation, "MOST", 9)
    assert merged(*functions) == set()


def test_lines_are_those_of_all_that_is_merged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Short functions, each called twice by the one before, are many copies in the end."""
    levels = [lines_of(f"f{k}", 9, f"f{k + 1}", f"f{k + 1}") for k in range(4)]
    functions = lines_of("step", 30, "f0", "f0"), *levels, lines_of("f4", 9)
    monkeypatch.setattr(optimisation, "MOST", 100)
    # 9, 9 + 2 * 9 = 27, 9 + 2 * 27 = 63, 9 + 2 * 63 = 135: that one is not merged, nor counted.
    assert merged(*functions) == {"f0", "f2", "f3", "f4"}


def test_a_function_that_calls_itself_is_not_looked_into_for_ever() -> None:
    assert merged(lines_of("step", 30, "again"), lines_of("again", 20, "again")) == set()
