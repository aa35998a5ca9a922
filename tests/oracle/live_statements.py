"""What of an engine's kernels is left for the compiler once branches that flags make dead are gone.

Numba translates a kernel's bytecode to statements of its own, drops dead branches, and only then
infers types and hands over to LLVM. Counted are these statements, those of every kernel that they
still call once. Inlining, layout of loops and vectors come later and change nothing here. Engines
have most of their kernels in common: one that is the same in its bytecode, its flags and all that
it calls (`identity`) is read once.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from numba import types
from numba.core import ir
from numba.core.analysis import dead_branch_prune, rewrite_semantic_constants
from numba.core.compiler import run_frontend

from lavendersim.engine.compile import Kernel
from lavendersim.engine.identity import identity

_read: dict[str, tuple[int, list[Kernel]]] = {}  # by identity: statements, and kernels they name


def live_statements(whole: Kernel) -> dict[Kernel, int]:
    """Return the number of statements of a kernel, and of every one that it calls, each once."""
    found: dict[str, tuple[Kernel, int]] = {}
    waiting = [whole]
    while waiting:
        kernel = waiting.pop()
        key = identity(kernel).digest
        if key not in found:
            if key not in _read:
                statements = list(_pruned(kernel.py_func))
                called = [one for statement in statements for one in _named_in(statement)]
                _read[key] = len(statements), called
            count, called = _read[key]
            found[key] = kernel, count
            waiting += called
    return dict(found.values())


def _pruned(function: Any) -> Iterator[Any]:
    """Yield the statements that numba types: those of no branch that a constant makes dead."""
    read = run_frontend(function)
    arguments = (types.unknown,) * read.arg_count  # no flag is an argument
    rewrite_semantic_constants(read, arguments)
    dead_branch_prune(read, arguments)
    for block in read.blocks.values():
        yield from block.body


def _named_in(statement: Any) -> Iterator[Kernel]:
    """Yield the kernels that a statement takes from outside of its function."""
    value = getattr(statement, "value", None)
    if isinstance(value, ir.Global | ir.FreeVar):
        several = value.value if isinstance(value.value, tuple) else (value.value,)
        yield from (one for one in several if isinstance(one, Kernel))
