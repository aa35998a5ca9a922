"""LLVM's values for kernels that take no instruction of their own, or one for a whole function.

To LLVM all pointers are alike; to llvmlite each has a type, and an instruction that changes it. One
in eight instructions of a part was such a one, to be made, written as a text, read and dropped.
Like `part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant
from llvmlite.ir.values import Value


class _Pointer(Value):  # type: ignore[misc]
    """A value under its own name, with another type of pointer."""

    def __init__(self, value: Any, kind: Any) -> None:
        self.type, self.get_reference = kind, value.get_reference


def pointing_to(builder: Any, value: Any, kind: Any) -> Any:
    """Return a pointer as one to values of a type."""
    if isinstance(value, Constant) or not hasattr(value, "get_reference"):
        return builder.bitcast(value, kind.as_pointer())
    pointer = kind.as_pointer()
    return value if value.type == pointer else _Pointer(value, pointer)


def slot(builder: Any, kind: Any) -> Any:
    """Return room for a value that is stored there before it is read; numba would store zero."""
    with builder.goto_entry_block():
        return builder.alloca(kind)


def at_entry(builder: Any, known: Any) -> Any:
    """Return what lies at a global constant, read once for a whole function."""
    read = builder.function.__dict__.setdefault("read_at_entry", {})
    found = read.get(known.name)
    if found is None:
        with builder.goto_entry_block():
            found = read[known.name] = builder.load(known)
    return found
