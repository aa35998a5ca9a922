"""Types of a kernel's variables are those that numba finds, whatever order they change in."""

from collections import namedtuple
from types import FunctionType
from typing import Any

import numpy as np
import pytest
from numba.core import types, typing
from numba.core.compiler import run_frontend
from numba.core.errors import TypingError
from numba.core.registry import cpu_target
from numba.core.typed_passes import type_inference_stage
from numba.np.numpy_support import from_dtype

shortcuts = pytest.importorskip("lavendersim.engine.compiler_shortcuts")
kernel_typing = pytest.importorskip("lavendersim.engine.kernel_typing")

ROW = np.dtype([("x", "f8"), ("n", "i8")], align=True)
ROWS = types.Array(from_dtype(ROW), 1, "C")
Pair = namedtuple("Pair", ["rows", "numbers"])
PAIR = types.NamedTuple((ROWS, types.Array(types.float64, 1, "C")), Pair)


def _widens_late(count, x):
    """Each pass round the loop widens one more of a chain of integers."""
    a = b = c = d = 0
    for _ in range(count):
        d = c + d
        c = b
        b = a
        a = x
    return d, a


def _reads_and_writes(pair, count):
    total, found = 0, (0, 1.5)
    for k, row in enumerate(pair.rows):
        row.x += k
        pair.numbers[k], pair.numbers[-1] = row.n, total
        first, second = found
        total = total + first if k else second
        pair.rows[0] = row
    return total, max(pair.numbers[count], 2), pair.rows.shape[0]


def _types(function: FunctionType, arguments: tuple[Any, ...], *, kernel: bool) -> Any:
    context, target = cpu_target.typing_context, cpu_target.target_context
    context.refresh()
    target.refresh()
    blocks = run_frontend(function)
    if kernel:
        blocks.func_id.is_kernel = True
        context = kernel_typing.quick(context)
    with shortcuts.shortened():
        found = type_inference_stage(context, target, blocks, arguments, None)
    calls = [(str(call), of) for call, of in found.calltypes.items()]
    return dict(found.typemap), found.return_type, calls


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (_widens_late, (types.int64, types.float64)),
        (_widens_late, (types.int64, types.int64)),
        (_reads_and_writes, (PAIR, types.int64)),
    ],
)
def test_types_are_those_that_numba_finds(function, arguments) -> None:
    expected = _types(function, arguments, kernel=False)
    assert _types(function, arguments, kernel=True) == expected
    assert len(expected[0]) >= 20


def test_a_type_that_does_not_fit_is_refused_in_numbas_words() -> None:
    def refused(rows):
        return rows.nothing + 1

    said = []
    for kernel in (False, True):
        with pytest.raises(TypingError) as error:
            _types(refused, (ROWS,), kernel=kernel)
        said.append(str(error.value))
    assert said[0] == said[1]
    assert "nothing" in said[0]


def test_a_constraint_is_asked_once_where_no_type_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    def sums(x, y):
        z = x * y
        return z + x

    asked = []
    resolve = typing.Context.resolve_function_type

    def counting(self: Any, function: Any, args: Any, kws: Any) -> Any:
        asked.append(function)
        return resolve(self, function, args, kws)

    monkeypatch.setattr(typing.Context, "resolve_function_type", counting)
    monkeypatch.setattr(kernel_typing, "_resolved", {})
    _types(sums, (types.float32, types.float64), kernel=True)
    assert len(asked) == 2
