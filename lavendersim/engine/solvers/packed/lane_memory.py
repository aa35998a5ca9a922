"""How sweeps read and write flat arrays: a number, a vector, or eight of them side by side.

Places are taken as they are given, without bounds or negative ones. A body's state is a line of the
processor's cache, a vector, 0, another vector, 0. Those of eight bodies are read line by line, and
transposed in registers: what one visit wrote is read whole by the next.

What nothing moves is read from the first line, which stays 0. What a visit would write there goes
to a line of its thread's own: nobody reads it, and no two threads write one line.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import signature

from .lanes import (
    DOUBLE,
    EIGHT,
    FOUR,
    INDEX,
    LANES,
    TRIPLE,
    TRIPLES,
    WIDTH,
    joined,
    parts_of,
    primitive,
    shuffled,
)

STRIDE = 8  # numbers from one body's state to the next
LINE = 8  # numbers of a line of the processor's cache
_LAST = [0, 1, 2, 7]  # of two vectors of four: x, y, z of the first, the second's last


def lines(numbers: int) -> np.ndarray:
    """Return zeros that begin with a line of the processor's cache."""
    padded = np.zeros(numbers + LINE)
    begin = -padded.ctypes.data // padded.itemsize % LINE
    return padded[begin : begin + numbers]


def place_of(context: Any, builder: Any, kind: Any, array_type: Any, array: Any, at: Any) -> Any:
    """Return a pointer to number `at` of a flat array."""
    data = context.make_array(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), ir.PointerType(kind))


def _load(builder: Any, pointer: Any) -> Any:
    # As a number alone is aligned: arrays begin with a line, but nothing holds them to it.
    loaded = builder.load(pointer)
    loaded.align = WIDTH
    return loaded


def _store(builder: Any, value: Any, pointer: Any) -> None:
    builder.store(value, pointer).align = WIDTH


def _make_take(kind: Any, stored: Any) -> Any:
    @primitive
    def take(typing, numbers, at):
        def emit(context, builder, sig, args):
            return _load(builder, place_of(context, builder, stored, sig.args[0], *args))

        return signature(kind, numbers, at), emit

    return take


def _make_put(stored: Any) -> Any:
    @primitive
    def put(typing, numbers, at, value):
        def emit(context, builder, sig, args):
            array, at, value = args
            _store(builder, value, place_of(context, builder, stored, sig.args[0], array, at))
            return context.get_dummy_value()

        return signature(types.void, numbers, at, value), emit

    return put


take_one, put_one = _make_take(types.float64, DOUBLE), _make_put(DOUBLE)
take_eight, put_eight = _make_take(LANES, EIGHT), _make_put(EIGHT)
# With it comes the number behind z, of which nobody asks.
take_triple = _make_take(TRIPLE, FOUR)


@primitive
def take_triples(typing, numbers, at):
    """Return Triples whose x, y and z lie eight by eight, one after the other."""

    def emit(context, builder, sig, args):
        first = place_of(context, builder, EIGHT, sig.args[0], *args)
        parts = [builder.gep(first, [ir.Constant(INDEX, k)]) for k in range(3)]
        return joined(builder, [_load(builder, part) for part in parts])

    return signature(TRIPLES, numbers, at), emit


def _halves(
    k: int, context: Any, builder: Any, sig: Any, args: Any, least: Any = None
) -> list[Any]:
    """Return pointers to the two vectors of the body whose state begins at ends[at + k].

    least: where it begins at least.
    """
    state, ends, at = args[:3]
    place = builder.add(at, ir.Constant(INDEX, k))
    body = builder.load(place_of(context, builder, INDEX, sig.args[1], ends, place))
    if least is not None:
        body = builder.select(builder.icmp_signed("<", body, least), least, body)
    first = place_of(context, builder, FOUR, sig.args[0], state, body)
    return [first, builder.gep(first, [ir.Constant(INDEX, 1)])]


@primitive
def take_body(typing, state, ends, at):
    """Return the two vectors of the body whose state begins at ends[at]."""

    def emit(context, builder, sig, args):
        halves = [_load(builder, half) for half in _halves(0, context, builder, sig, args)]
        return context.make_tuple(builder, sig.return_type, halves)

    return signature(types.UniTuple(TRIPLE, 2), state, ends, at), emit


@primitive
def put_body(typing, state, ends, at, own, vectors):
    """Write the two vectors of a body back; own: the line of what nothing moves."""

    def emit(context, builder, sig, args):
        nothing = ir.Constant(FOUR, [0.0] * 4)
        halves = _halves(0, context, builder, sig, args, args[3])
        for vector, half in zip(cgutils.unpack_tuple(builder, args[4]), halves, strict=True):
            _store(builder, shuffled(builder, vector, nothing, _LAST), half)
        return context.get_dummy_value()

    return signature(types.void, state, ends, at, own, vectors), emit


def _swapped(builder: Any, rows: list[Any], distance: int) -> list[Any]:
    """Swap across the diagonal of every square of 2 `distance`: one stage of a transposition.

    rows: four of eight numbers, which are two squares of four beside each other.
    """
    low = [k if not k & distance else k - distance + WIDTH for k in range(WIDTH)]
    high = [k + distance if not k & distance else k + WIDTH for k in range(WIDTH)]
    out = list(rows)
    for k in range(4):
        if not k & distance:
            out[k] = shuffled(builder, rows[k], rows[k + distance], low)
            out[k + distance] = shuffled(builder, rows[k], rows[k + distance], high)
    return out


@primitive
def take_bodies(typing, state, ends, at):
    """Return the two Triples of the eight bodies whose states begin at ends[at:]."""

    def emit(context, builder, sig, args):
        lines = [_halves(k, context, builder, sig, args) for k in range(WIDTH)]
        triples = []
        for half in (0, 1):
            # Bodies k and k + 4 beside each other: two squares of four, each transposed.
            both = [
                shuffled(
                    builder,
                    _load(builder, lines[k][half]),
                    _load(builder, lines[k + 4][half]),
                    range(WIDTH),
                )
                for k in range(4)
            ]
            x, y, z, _ = _swapped(builder, _swapped(builder, both, 2), 1)
            triples.append(joined(builder, [x, y, z]))
        return context.make_tuple(builder, sig.return_type, triples)

    return signature(types.UniTuple(TRIPLES, 2), state, ends, at), emit


@primitive
def put_bodies(typing, state, ends, at, own, vectors):
    """Write the two Triples of eight bodies back; a body named twice keeps the last.

    own: the line of what nothing moves.
    """

    def emit(context, builder, sig, args):
        lines = [_halves(k, context, builder, sig, args, args[3]) for k in range(WIDTH)]
        nothing = ir.Constant(EIGHT, [0.0] * WIDTH)
        for half, triples in enumerate(cgutils.unpack_tuple(builder, args[4])):
            columns = [*parts_of(builder, triples), nothing]
            for k, both in enumerate(_swapped(builder, _swapped(builder, columns, 1), 2)):
                for body in (k, k + 4):
                    begin = body - k
                    four = shuffled(builder, both, both, range(begin, begin + 4))
                    _store(builder, four, lines[body][half])
        return context.get_dummy_value()

    return signature(types.void, state, ends, at, own, vectors), emit
