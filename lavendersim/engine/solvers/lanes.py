"""Eight float64 side by side, and what sweeps do with one number or with eight: primitives.

`Lanes` is a type of kernels' local variables: LLVM's <8 x double>, which it splits into what the
processor has. +, - and * work on them as on numbers, and `positive`, `where_greater`, `root`, ...
take either, so that one text serves a sweep over single contacts and one over eight at a time.
Every lane gets exactly the operations that a single number gets, in the same order and rounded in
the same way (no contraction): both give the same bits.

Numbers are taken by their place in flat arrays, without bounds or negative indices.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing import signature
from numba.core.typing.templates import ConcreteTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, models, register_model

WIDTH = 8
# A body's numbers in the sweeps' state: three of its linear velocity, three of its angular one.
BODY_WIDTH = 6
STRIDE = 8  # numbers from one body to the next: a line of the processor's cache

_DOUBLE = ir.DoubleType()
_EIGHT = ir.VectorType(_DOUBLE, WIDTH)
_FOUR = ir.VectorType(_DOUBLE, 4)
_INDEX = ir.IntType(64)


class LanesType(types.Type):
    """Numba's type of eight float64 side by side."""

    def __init__(self) -> None:
        super().__init__(name="Lanes8")


LANES = LanesType()


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, front: Any) -> None:
        super().__init__(manager, front, _EIGHT)


def _operates(function: Callable[..., Any], emit: str) -> None:
    """Let an operator of Python's work on lanes by one instruction of LLVM's."""

    class Template(ConcreteTemplate):
        cases = [signature(LANES, LANES, LANES)]  # noqa: RUF012 - numba reads it off the class

    def lower(context, builder, sig, args):
        return getattr(builder, emit)(*args)

    infer_global(function)(Template)
    lower_builtin(function, LANES, LANES)(lower)


_operates(operator.add, "fadd")
_operates(operator.sub, "fsub")
_operates(operator.mul, "fmul")
_operates(operator.truediv, "fdiv")


def _numbers(*kinds: Any) -> Any:
    """Return the type that all of `kinds` share; None where they are no numbers or differ."""
    (kind, *others) = kinds
    alike = kind in (LANES, types.float64) and all(other == kind for other in others)
    return kind if alike else None


def _of(kind: Any, number: float) -> ir.Constant:
    return ir.Constant(_DOUBLE, number) if kind != LANES else ir.Constant(_EIGHT, [number] * WIDTH)


def _call(builder: Any, name: str, value: Any) -> Any:
    """Call one of LLVM's own functions of a number or of lanes."""
    suffix = "f64" if value.type == _DOUBLE else "v8f64"
    kind = ir.FunctionType(value.type, [value.type])
    return builder.call(builder.module.declare_intrinsic(f"{name}.{suffix}", (), kind), [value])


@intrinsic
def positive(typing, x):
    """Return x, or 0 where it is less; a NaN stays."""
    kind = _numbers(x)

    def emit(context, builder, sig, args):
        zero = _of(kind, 0.0)
        return builder.select(builder.fcmp_ordered("<", args[0], zero), zero, args[0])

    return signature(kind, x), emit


@intrinsic
def magnitude(typing, x):
    """Return |x|."""
    kind = _numbers(x)

    def emit(context, builder, sig, args):
        return _call(builder, "llvm.fabs", args[0])

    return signature(kind, x), emit


@intrinsic
def root(typing, x):
    """Return the square root of x, rounded correctly."""
    kind = _numbers(x)

    def emit(context, builder, sig, args):
        return _call(builder, "llvm.sqrt", args[0])

    return signature(kind, x), emit


@intrinsic
def greater(typing, x, most):
    """Return x where it is greater than `most`, else `most`; a NaN in x is passed over."""
    kind = _numbers(x, most)

    def emit(context, builder, sig, args):
        return builder.select(builder.fcmp_ordered(">", *args), *args)

    return signature(kind, x, most), emit


@intrinsic
def where_greater(typing, a, b, x, y):
    """Return x where a > b, else y."""
    kind = _numbers(a, b, x, y)

    def emit(context, builder, sig, args):
        a, b, x, y = args
        return builder.select(builder.fcmp_ordered(">", a, b), x, y)

    return signature(kind, a, b, x, y), emit


@intrinsic
def any_greater(typing, a, b):
    """Return whether a > b, in any lane."""
    kind = _numbers(a, b)

    def emit(context, builder, sig, args):
        above = builder.fcmp_ordered(">", *args)
        if kind == LANES:
            bits = builder.bitcast(above, ir.IntType(WIDTH))
            above = builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))
        return above

    return signature(types.boolean, a, b), emit


@intrinsic
def lane(typing, x, k):
    """Return the number in lane k."""

    def emit(context, builder, sig, args):
        return builder.extract_element(*args)

    return signature(types.float64, x, k), emit


@intrinsic
def zeros(typing):
    """Return eight zeros."""

    def emit(context, builder, sig, args):
        return _of(LANES, 0.0)

    return signature(LANES), emit


def _place(context: Any, builder: Any, array_type: Any, array: Any, at: Any, kind: Any) -> Any:
    """Return a pointer to number `at` of a flat array."""
    data = context.make_array(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), ir.PointerType(kind))


def _load(builder: Any, pointer: Any) -> Any:
    # Lines of the cache where arrays begin with one; nothing is promised.
    loaded = builder.load(pointer)
    loaded.align = WIDTH
    return loaded


def _store(builder: Any, value: Any, pointer: Any) -> None:
    builder.store(value, pointer).align = WIDTH


def _make_take(kind: Any, stored: Any) -> Any:
    @intrinsic
    def take(typing, numbers, at):
        def emit(context, builder, sig, args):
            return _load(builder, _place(context, builder, sig.args[0], *args, stored))

        return signature(kind, numbers, at), emit

    return take


def _make_put(kind: Any, stored: Any) -> Any:
    @intrinsic
    def put(typing, numbers, at, value):
        def emit(context, builder, sig, args):
            array, at, value = args
            _store(builder, value, _place(context, builder, sig.args[0], array, at, stored))
            return context.get_dummy_value()

        return signature(types.void, numbers, at, value), emit

    return put


take_one, take_eight = _make_take(types.float64, _DOUBLE), _make_take(LANES, _EIGHT)
put_one, put_eight = _make_put(types.float64, _DOUBLE), _make_put(LANES, _EIGHT)


def _shuffled(builder: Any, a: Any, b: Any, mask: list[int]) -> Any:
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(ir.IntType(32), len(mask)), mask))


def _swapped(builder: Any, rows: list[Any], distance: int) -> list[Any]:
    """Swap blocks across the diagonal of every square of 2 `distance`: a stage of a transposition.

    rows: of eight numbers; as many as reach, of each square.
    """
    out = list(rows)
    low = [k if not k & distance else k - distance + WIDTH for k in range(WIDTH)]
    high = [k + distance if not k & distance else k + WIDTH for k in range(WIDTH)]
    for k in range(len(rows)):
        if not k & distance:
            out[k] = _shuffled(builder, rows[k], rows[k + distance], low)
            out[k + distance] = _shuffled(builder, rows[k], rows[k + distance], high)
    return out


def _bodies(context: Any, builder: Any, sig: Any, state: Any, ends: Any, at: Any) -> list[Any]:
    """Return pointers to the two halves (of four numbers) of the lines of eight bodies."""
    state_type, ends_type = sig.args[0], sig.args[1]
    pointers = []
    for k in range(WIDTH):
        body = builder.load(
            _place(
                context, builder, ends_type, ends, builder.add(at, ir.Constant(_INDEX, k)), _INDEX
            )
        )
        first = _place(context, builder, state_type, state, body, _FOUR)
        pointers.append((first, builder.gep(first, [ir.Constant(_INDEX, 1)])))
    return pointers


@intrinsic
def take_bodies_eight(typing, state, ends, at):
    """Return the six velocities of the eight bodies whose lines begin at ends[at:], by lane."""
    found = types.UniTuple(LANES, BODY_WIDTH)

    def emit(context, builder, sig, args):
        lines = _bodies(context, builder, sig, *args)
        columns = []
        for half in (0, 1):
            # Halves of body k and k + 4 together: the last stage of the transposition.
            joined = [
                _shuffled(
                    builder,
                    _load(builder, lines[k][half]),
                    _load(builder, lines[k + 4][half]),
                    list(range(WIDTH)),
                )
                for k in range(4)
            ]
            columns += _swapped(builder, _swapped(builder, joined, 2), 1)
        return context.make_tuple(builder, sig.return_type, columns[:BODY_WIDTH])

    return signature(found, state, ends, at), emit


@intrinsic
def put_bodies_eight(typing, state, ends, at, velocities):
    """Write the six velocities of eight bodies back; a body named twice gets the last."""

    def emit(context, builder, sig, args):
        state, ends, at, velocities = args
        lines = _bodies(context, builder, sig, state, ends, at)
        zero = _of(LANES, 0.0)
        columns = [*cgutils.unpack_tuple(builder, velocities, BODY_WIDTH), zero, zero]
        for half in (0, 1):
            joined = _swapped(builder, _swapped(builder, columns[4 * half : 4 * half + 4], 1), 2)
            for k, both in enumerate(joined):
                for first, body in ((0, k), (4, k + 4)):
                    four = _shuffled(builder, both, both, list(range(first, first + 4)))
                    _store(builder, four, lines[body][half])
        return context.get_dummy_value()

    return signature(types.void, state, ends, at, velocities), emit


@intrinsic
def take_bodies_one(typing, state, ends, at):
    """Return the six velocities of the body whose line begins at ends[at]."""
    found = types.UniTuple(types.float64, BODY_WIDTH)

    def emit(context, builder, sig, args):
        state, ends, at = args
        body = builder.load(_place(context, builder, sig.args[1], ends, at, _INDEX))
        first = _place(context, builder, sig.args[0], state, body, _DOUBLE)
        values = [builder.load(builder.gep(first, [ir.Constant(_INDEX, k)])) for k in range(6)]
        return context.make_tuple(builder, sig.return_type, values)

    return signature(found, state, ends, at), emit


@intrinsic
def put_bodies_one(typing, state, ends, at, velocities):
    """Write the six velocities of a body back."""

    def emit(context, builder, sig, args):
        state, ends, at, velocities = args
        body = builder.load(_place(context, builder, sig.args[1], ends, at, _INDEX))
        first = _place(context, builder, sig.args[0], state, body, _DOUBLE)
        for k, value in enumerate(cgutils.unpack_tuple(builder, velocities, BODY_WIDTH)):
            builder.store(value, builder.gep(first, [ir.Constant(_INDEX, k)]))
        return context.get_dummy_value()

    return signature(types.void, state, ends, at, velocities), emit
