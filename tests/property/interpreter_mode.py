"""A process in which kernels are never compiled: each call from Python is interpreted.

`begin()` comes before tests are imported. `broken(path, text)` gives the functions of a module that
is loaded the code of another text of it: what makers made before, and will make, is of that text.
Code that is written for LLVM (`packed/lanes.py`) cannot be interpreted: its tests fail here.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

ORACLE = Path(__file__).parents[1] / "oracle"


class Plain:
    """What `numba.njit` makes of a function of a test."""

    def __init__(self, function: Any) -> None:
        self.py_func = function
        self.overloads: dict[Any, Any] = {}

    def __call__(self, *arguments: Any) -> Any:
        return _called(self, arguments)


_made: dict[int, tuple[Any, Any]] = {}  # with the kernel, which keeps its number


def _called(kernel: Any, arguments: tuple[Any, ...]) -> Any:
    from interpreted import interpreted, records  # type: ignore[import-not-found]

    if id(kernel) not in _made:
        _made[id(kernel)] = kernel, interpreted(kernel)
    return _made[id(kernel)][1](*(records(one) for one in arguments))


def begin() -> None:
    """Let no kernel of this process be compiled."""
    sys.path.insert(0, str(ORACLE))
    import numba

    from lavendersim.engine import engine, step
    from lavendersim.engine.part_compiler import Kernel

    def njit(function: Any = None, **_: Any) -> Any:
        return Plain if function is None else Plain(function)

    def interpret(kernel: Any, *arguments: Any) -> Any:
        return _called(kernel, arguments)

    changes = (numba, "njit", njit), (Kernel, "__call__", interpret)
    for place, name, other in (*changes, (engine, "advance_for", step.make_advance)):
        setattr(place, name, other)


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def broken(path: Path, text: str) -> int:
    """Give functions of a module's file the code of another text; returns how many."""
    old = compile(path.read_text(), str(path), "exec", dont_inherit=True)
    new = compile(text, str(path), "exec", dont_inherit=True)
    changed = {
        (one.co_qualname, one.co_firstlineno): other
        for one, other in zip(_codes(old), _codes(new), strict=True)
        if one != other
    }
    count = 0
    gc.unfreeze()
    for function in gc.get_objects():
        if type(function) is FunctionType and function.__code__.co_filename == str(path):
            code = function.__code__
            other = changed.get((code.co_qualname, code.co_firstlineno))
            if other is not None:
                function.__code__ = other
                count += 1
    return count
