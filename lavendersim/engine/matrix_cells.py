"""Cells of arrays of several axes, `factor[i, j]`: where they lie, in few instructions.

Numba asks for the view that any index could make, and has it be one number in the end. Like
`part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from typing import Any

from llvmlite.ir import Constant, IntType
from numba.core import types

from .field_places import FIELDS

WORD = IntType(64)
INDICES = types.int64, types.uint64


def is_cell(kind: Any, index: Any) -> bool:
    """Whether a type of index names one number of an array of such a type, row after row."""
    if not (isinstance(kind, types.Array) and isinstance(index, types.BaseTuple)):
        return False
    along: Any = index
    plain = kind.layout == "C" and kind.aligned and kind.dtype in FIELDS
    numbers = all(types.unliteral(each) in INDICES for each in along)
    return plain and kind.ndim == len(along) > 1 and numbers


def cell_at(builder: Any, models: Any, kind: Any, array: Any, index: Any, along: Any) -> Any:
    """Return where a cell is; a signed index counts from the end where it is negative.

    models: of data; array, index: values of types `kind` and `along`.
    """
    place = models[kind].get_field_position
    at = Constant(WORD, 0)
    for axis, number in enumerate(along):
        count = builder.extract_value(array, (place("shape"), axis))
        step = builder.extract_value(index, axis)
        if not _is_from_the_begin(number):
            negative = builder.icmp_signed("<", step, Constant(WORD, 0))
            step = builder.select(negative, builder.add(step, count), step)
        at = builder.add(builder.mul(at, count), step) if axis else step
    return builder.gep(builder.extract_value(array, place("data")), (at,))


def _is_from_the_begin(number: Any) -> bool:
    return number == types.uint64 or getattr(number, "literal_value", -1) >= 0
