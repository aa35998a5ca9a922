"""Loops over `range` as kernels have them: the step is known, and nothing can be raised.

    for i in range(3, n):     value 3, left max(n - 3, 0); while left > 0: value += 1, left -= 1

Numba asks each time whether the step is zero, for which it would raise an error: then every caller
of a kernel with a loop asks about errors, too. Its loops have three times as many instructions.
Like `part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant, Undefined
from numba.core import types
from numba.core.datamodel.registry import default_manager

from .light_values import slot

RANGE, ITERATOR = types.range_state64_type, types.range_iter64_type


def _place(kind: Any, name: str) -> int:
    return int(default_manager[kind].get_field_position(name))


def _filled(builder: Any, kind: Any, **fields: Any) -> Any:
    """Return a value of a type whose fields have these values."""
    value = Constant(default_manager[kind].get_value_type(), Undefined)
    for name, field in fields.items():
        value = builder.insert_value(value, field, _place(kind, name))
    return value


def limits(builder: Any, start: Any, stop: Any, step: int) -> Any:
    """Return a range."""
    return _filled(builder, RANGE, start=start, stop=stop, step=Constant(start.type, step))


def begun(builder: Any, within: Any, step: int) -> Any:
    """Return the iterator over a range with this step, which is not 0."""
    start = builder.extract_value(within, _place(RANGE, "start"))
    stop = builder.extract_value(within, _place(RANGE, "stop"))
    number, zero = start.type, Constant(start.type, 0)
    left = builder.sub(stop, start) if step > 0 else builder.sub(start, stop)
    if abs(step) > 1:
        left = builder.add(left, Constant(number, abs(step) - 1))
        left = builder.sdiv(left, Constant(number, abs(step)))
    left = builder.select(builder.icmp_signed(">", left, zero), left, zero)
    value, count = (slot(builder, number) for _ in range(2))
    builder.store(start, value)
    builder.store(left, count)
    steps = Constant(number, step)
    return _filled(builder, ITERATOR, iter=value, stop=stop, step=steps, count=count)


def next_of(builder: Any, iterator: Any, pair: Any) -> Any:
    """Return the next value and whether there is one, as a pair of that type, and go on."""
    here = builder.extract_value(iterator, _place(ITERATOR, "iter"))
    count = builder.extract_value(iterator, _place(ITERATOR, "count"))
    step = builder.extract_value(iterator, _place(ITERATOR, "step"))
    value, left = builder.load(here), builder.load(count)
    there = builder.icmp_signed(">", left, Constant(left.type, 0))
    builder.store(builder.sub(left, Constant(left.type, 1), flags=["nsw"]), count)
    builder.store(builder.add(value, step), here)
    return _filled(builder, pair, first=value, second=there)
