"""Asking for records before they are read: the processor follows a run of them, not an order.

Records of contacts take hundreds of bytes, and an order of visits jumps among them. Where they do
not fit into the caches, a visit would wait for its record; asked for some visits before, it comes
as fast as memory gives. It changes no bit.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import signature

from .solvers.packed.lanes import primitive

# Visits between asking for a record and reading it.
AHEAD = 4
LINE = 64  # bytes of a line of the processor's cache
_BYTE, _FLAG = ir.IntType(8), ir.IntType(32)
_FUNCTION = ir.FunctionType(
    ir.VoidType(), [ir.PointerType(_BYTE), _FLAG, _FLAG, _FLAG]
)  # place, 1: it will be written, 0 to 3: how near, 1: data


# What a solve writes of a contact.
_IMPULSES = ("lambda_n", "lambda_1", "lambda_2", "psi_n", "psi_1", "psi_2")


def _emit(context: Any, builder: Any, array_type: Any, args: Any, places: Any) -> Any:
    """Ask for the lines that have these bytes of a row."""
    array, at = args
    data = context.make_array(array_type)(context, builder, array).data
    row = builder.bitcast(builder.gep(data, [at]), ir.PointerType(_BYTE))
    ask = builder.module.declare_intrinsic("llvm.prefetch.p0i8", (), _FUNCTION)
    flags = [ir.Constant(_FLAG, flag) for flag in (1, 3, 1)]
    for place in places:
        builder.call(ask, [builder.gep(row, [ir.Constant(_FLAG, place)]), *flags])
    return context.get_dummy_value()


@primitive
def prefetch(typing, records, at):
    """Ask for all of records[at]; at: a row, which is not looked at."""

    def emit(context, builder, sig, args):
        size = sig.args[0].dtype.size
        return _emit(context, builder, sig.args[0], args, range(0, size, LINE))

    return signature(types.void, records, at), emit


def make_prefetch_span(names: tuple[str, ...]) -> Any:
    """Return `kernel(records, at)`: ask for what of records[at] lies between these fields.

    Of those that the records have; at: a row, which is not looked at.
    """

    @primitive
    def prefetch_span(typing, records, at):
        def emit(context, builder, sig, args):
            record = sig.args[0].dtype
            places = [record.offset(name) for name in names if name in record.fields]
            first, last = min(places), max(places)
            lines = [*range(first, last, LINE), last]
            return _emit(context, builder, sig.args[0], args, lines)

        return signature(types.void, records, at), emit

    return prefetch_span


@primitive
def prefetch_impulses(typing, records, at):
    """Ask for the impulses of a contact, records[at]."""

    def emit(context, builder, sig, args):
        record, places = sig.args[0].dtype, dict[int, int]()
        for name in _IMPULSES:
            if name in record.fields:  # one of a line asks for it
                places.setdefault(record.offset(name) // LINE, record.offset(name))
        return _emit(context, builder, sig.args[0], args, places.values())

    return signature(types.void, records, at), emit
