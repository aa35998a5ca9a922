"""Kernels as Python functions, with all that they call: a test of a formula compiles nothing.

`interpreted(kernel)` runs the kernel's source in Python's interpreter: a sign, an index or a factor
is seen there as well as in compiled code, which tests of engines run. A division by zero raises.
`records(arrays)` are views of arrays that kernels write to, whose rows have their fields by name,
as they have in kernels.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import CellType, CodeType, FunctionType
from typing import Any

import numpy as np


class Row:
    """A row of an array of records, by the names of its fields."""

    __slots__ = ("_row",)

    def __init__(self, row: np.void) -> None:
        object.__setattr__(self, "_row", row)

    def __getattr__(self, name: str) -> Any:
        try:
            return self._row[name].item()
        except ValueError:
            raise AttributeError(name) from None

    def __setattr__(self, name: str, value: Any) -> None:
        self._row[name] = value

    def __getitem__(self, name: str) -> Any:
        return self._row[name].item()

    def __setitem__(self, name: str, value: Any) -> None:
        self._row[name] = value


class Rows:
    """An array of records: its rows by number, its columns by name."""

    def __init__(self, array: np.ndarray) -> None:
        self.array = array
        self.shape = array.shape

    def __len__(self) -> int:
        return len(self.array)

    def __iter__(self) -> Iterator[Row]:
        return (Row(row) for row in self.array)

    def __getitem__(self, place: Any) -> Any:
        found = self.array[place]
        if isinstance(found, np.void):
            return Row(found)
        return Rows(found) if found.dtype.names else found

    def __setitem__(self, place: Any, value: Any) -> None:
        self.array[place] = value._row if isinstance(value, Row) else value


def interpreted(kernel: Any) -> Callable[..., Any]:
    """Return the Python function of a kernel, which calls those of other kernels."""
    return _function(kernel, {})


def records(value: Any) -> Any:
    """Return a view of an array of records, or of each of a tuple."""
    if isinstance(value, tuple):
        each = [records(one) for one in value]
        return value._make(each) if hasattr(value, "_make") else tuple(each)
    if isinstance(value, np.ndarray) and value.dtype.names:
        return Rows(value)
    return value


def _function(kernel: Any, known: dict[int, Any]) -> Any:
    if id(kernel) in known:
        return known[id(kernel)]
    source = kernel.py_func
    space = dict(source.__globals__)
    made = FunctionType(
        source.__code__, space, source.__name__, source.__defaults__, _cells(source, known)
    )
    known[id(kernel)] = made
    for name in _names(source.__code__):
        if name in space:
            space[name] = _value(space[name], known)
    return made


def _cells(source: FunctionType, known: dict[int, Any]) -> tuple[Any, ...]:
    return tuple(CellType(_value(cell.cell_contents, known)) for cell in source.__closure__ or ())


def _value(value: Any, known: dict[int, Any]) -> Any:
    if hasattr(value, "py_func"):
        return _function(value, known)
    if type(value) is tuple:
        return tuple(_value(one, known) for one in value)
    return value


def _names(code: CodeType) -> set[str]:
    names = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            names |= _names(constant)
    return names
