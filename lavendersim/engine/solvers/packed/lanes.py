"""Numbers side by side, and what a sweep does with them: primitives of kernels, in LLVM's vectors.

    float64   a number                      Triple    x, y, z of one vector
    Lanes     eight numbers, one of each    Triples   x, y, z of eight vectors, of a Lanes each
              of eight contacts
+, - and * work on them alike, a triple times a number included, and so do the functions here: one
text serves a sweep over single contacts and one over eight at a time. Every lane gets exactly the
operations that a single number gets, in the same order and with the same rounding (nothing is
contracted), so both give the same bits. LLVM splits vectors into what the processor has.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

WIDTH = 8
# To a type checker the function has the arguments that only the compiler gives it.
primitive: Any = intrinsic

DOUBLE, INDEX = ir.DoubleType(), ir.IntType(64)
EIGHT = ir.VectorType(DOUBLE, WIDTH)
FOUR = ir.VectorType(DOUBLE, 4)  # x, y, z and one that is never looked at


class LanesType(types.Type):
    """Numba's type of eight float64 side by side."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


class TripleType(types.Type):
    """Numba's type of one vector."""

    def __init__(self) -> None:
        super().__init__(name="Triple")


class TriplesType(types.Type):
    """Numba's type of eight vectors side by side."""

    def __init__(self) -> None:
        super().__init__(name="Triples")


LANES, TRIPLE, TRIPLES = LanesType(), TripleType(), TriplesType()
_MODELS = {LanesType: EIGHT, TripleType: FOUR, TriplesType: ir.ArrayType(EIGHT, 3)}


def _represent(kind: type, vector: Any) -> None:
    class Model(models.PrimitiveModel):
        def __init__(self, manager: Any, front: Any) -> None:
            super().__init__(manager, front, vector)

    register_model(kind)(Model)


for _kind, _vector in _MODELS.items():
    _represent(_kind, _vector)


def parts_of(builder: Any, triples: Any) -> list[Any]:
    """Return the x, y and z of Triples."""
    return [builder.extract_value(triples, k) for k in range(3)]


def joined(builder: Any, parts: Sequence[Any]) -> Any:
    """Return Triples of an x, y and z."""
    whole = ir.Constant(_MODELS[TriplesType], ir.Undefined)
    for k, part in enumerate(parts):
        whole = builder.insert_value(whole, part, k)
    return whole


def shuffled(builder: Any, a: Any, b: Any, mask: Sequence[int]) -> Any:
    """Return the numbers of two vectors, one after the other, that `mask` chooses, by place."""
    chosen = ir.Constant(ir.VectorType(ir.IntType(32), len(mask)), list(mask))
    return builder.shuffle_vector(a, b, chosen)


def _as_triple(builder: Any, number: Any) -> Any:
    """Return a vector of a number in every place."""
    one = builder.insert_element(ir.Constant(FOUR, ir.Undefined), number, ir.Constant(INDEX, 0))
    return shuffled(builder, one, one, [0] * 4)


def _operate(builder: Any, emit: str, kinds: Sequence[Any], a: Any, b: Any) -> Any:
    """Emit one operation on every number of `a`, with the like of `b` or with the number `b`."""
    instruction = getattr(builder, emit)
    if kinds[0] == TRIPLES:
        others = parts_of(builder, b) if kinds[1] == TRIPLES else [b] * 3
        both = zip(parts_of(builder, a), others, strict=True)
        return joined(builder, [instruction(x, y) for x, y in both])
    if kinds[0] == TRIPLE and kinds[1] == types.float64:
        b = _as_triple(builder, b)
    return instruction(a, b)


def _operates(function: Callable[..., Any], emit: str, pairs: Sequence[tuple[Any, Any]]) -> None:
    """Let an operator of Python's work on pairs of types by one instruction of LLVM's."""

    class Template(ConcreteTemplate):
        cases = [signature(a, a, b) for a, b in pairs]  # noqa: RUF012 - numba reads it here

    def lower(context, builder, sig, args):
        return _operate(builder, emit, sig.args, *args)

    infer_global(function)(Template)
    for a, b in pairs:
        lower_builtin(function, a, b)(lower)


_ALIKE = [(kind, kind) for kind in (LANES, TRIPLE, TRIPLES)]
_operates(operator.add, "fadd", _ALIKE)
_operates(operator.sub, "fsub", _ALIKE)
_operates(operator.mul, "fmul", [*_ALIKE, (TRIPLE, types.float64), (TRIPLES, LANES)])
_operates(operator.truediv, "fdiv", [(LANES, LANES)])


@primitive
def total(typing, triple):
    """Return x + y + z."""

    def emit(context, builder, sig, args):
        if sig.args[0] == TRIPLES:
            x, y, z = parts_of(builder, *args)
        else:
            x, y, z = (builder.extract_element(args[0], ir.Constant(INDEX, k)) for k in range(3))
        return builder.fadd(builder.fadd(x, y), z)

    return signature(LANES if triple == TRIPLES else types.float64, triple), emit


def _of(kind: Any, number: float) -> ir.Constant:
    return ir.Constant(DOUBLE, number) if kind != LANES else ir.Constant(EIGHT, [number] * WIDTH)


def _call(builder: Any, name: str, value: Any) -> Any:
    """Call one of LLVM's own functions of a number or of lanes."""
    suffix = "f64" if value.type == DOUBLE else "v8f64"
    kind = ir.FunctionType(value.type, [value.type])
    return builder.call(builder.module.declare_intrinsic(f"{name}.{suffix}", (), kind), [value])


@primitive
def positive(typing, x):
    """Return x, or 0 where it is less; a NaN stays."""

    def emit(context, builder, sig, args):
        zero = _of(sig.args[0], 0.0)
        return builder.select(builder.fcmp_ordered("<", args[0], zero), zero, args[0])

    return signature(x, x), emit


@primitive
def magnitude(typing, x):
    """Return |x|."""

    def emit(context, builder, sig, args):
        return _call(builder, "llvm.fabs", args[0])

    return signature(x, x), emit


@primitive
def root(typing, x):
    """Return the square root of x, rounded correctly."""

    def emit(context, builder, sig, args):
        return _call(builder, "llvm.sqrt", args[0])

    return signature(x, x), emit


@primitive
def greater(typing, x, most):
    """Return x where it is greater than `most`, else `most`; a NaN in x is passed over."""

    def emit(context, builder, sig, args):
        return builder.select(builder.fcmp_ordered(">", *args), *args)

    return signature(x, x, most), emit


@primitive
def where_greater(typing, a, b, x, y):
    """Return x where a > b, else y."""

    def emit(context, builder, sig, args):
        return builder.select(builder.fcmp_ordered(">", *args[:2]), *args[2:])

    return signature(x, a, b, x, y), emit


@primitive
def clamped(typing, x, limit):
    """Return the number nearest to x of no greater magnitude than `limit`; a NaN stays."""

    def emit(context, builder, sig, args):
        x, limit = args
        least = builder.fneg(limit)
        x = builder.select(builder.fcmp_ordered("<", x, least), least, x)
        return builder.select(builder.fcmp_ordered(">", x, limit), limit, x)

    return signature(x, x, limit), emit


@primitive
def any_greater(typing, a, b):
    """Return whether a > b, in any lane."""

    def emit(context, builder, sig, args):
        above = builder.fcmp_ordered(">", *args)
        if sig.args[0] == LANES:
            bits = builder.bitcast(above, ir.IntType(WIDTH))
            above = builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))
        return above

    return signature(types.boolean, a, b), emit


@primitive
def lane(typing, x, k):
    """Return the number in lane k."""

    def emit(context, builder, sig, args):
        return builder.extract_element(*args)

    return signature(types.float64, x, k), emit


@primitive
def zeros(typing):
    """Return eight zeros."""

    def emit(context, builder, sig, args):
        return _of(LANES, 0.0)

    return signature(LANES), emit


@primitive
def spread(typing, x):
    """Return a number eight times."""

    def emit(context, builder, sig, args):
        one = builder.insert_element(
            ir.Constant(EIGHT, ir.Undefined), args[0], ir.Constant(INDEX, 0)
        )
        return shuffled(builder, one, one, [0] * WIDTH)

    return signature(LANES, x), emit
