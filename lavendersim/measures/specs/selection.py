"""Swept values as an expectation or a figure names them: which cells of a sweep are meant.

`at: {e: 0.8, timestep: 1/480}` selects the cells with these coordinates, a list means "one of
these", and `any` selects every cell that has the axis at all (a sweep may be several products,
each with axes of its own).
"""

from __future__ import annotations

from typing import Annotated, Any, Final

from pydantic import BeforeValidator, PlainValidator, ValidationInfo, WithJsonSchema

from lavendersim.quantities.names import AxisName
from lavendersim.quantities.quantity import refusal

ANY = "any"
_SCALAR: Final = {"type": ["boolean", "number", "string"]}
_SCHEMA: Final = {"anyOf": [_SCALAR, {"type": "array", "items": _SCALAR, "minItems": 1}]}


def _coordinate(value: object) -> object:
    """Return a scalar as it is and a list as a tuple of scalars, or raise the refusal."""
    if _is_scalar(value):
        return value
    if isinstance(value, list | tuple) and value and all(map(_is_scalar, value)):
        return tuple(value)
    raise refusal("a swept value, a list of swept values, or `any`", value)


def _is_scalar(value: object) -> bool:
    return isinstance(value, bool | int | float | str)


def _among_the_swept(value: object, info: ValidationInfo) -> object:
    """Have the file that is read look for every value among the swept ones."""
    if info.context is not None:
        info.context.check_selection(value)
    return value


# One swept value or a list of them, kept as read: a ratio stays a ratio.
Coordinate = Annotated[Any, PlainValidator(_coordinate), WithJsonSchema(_SCHEMA)]
Selection = Annotated[dict[AxisName, Coordinate], BeforeValidator(_among_the_swept)]
