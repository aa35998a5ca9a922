"""Swept values as an expectation or a figure names them: which cells of a sweep are meant.

`at: {e: 0.8, timestep: 1/480}` selects the cells with these coordinates, a list means "one of
these", and `any` selects every cell that has the axis at all (a sweep may be several products,
each with axes of its own).
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from lavendersim.quantities.names import AxisName
from lavendersim.quantities.quantity import refusal

ANY = "any"


class _Coordinate:
    """One swept value or a list of them, kept as read (a ratio stays a ratio)."""

    def check(self, value: object) -> object:
        """Return a scalar as it is and a list as a tuple of scalars, or raise the refusal."""
        if _is_scalar(value):
            return value
        if isinstance(value, list | tuple) and value and all(map(_is_scalar, value)):
            return tuple(value)
        raise refusal("a swept value, a list of swept values, or `any`", value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate with `check`."""
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Describe a scalar or a list of scalars."""
        scalar = {"type": ["boolean", "number", "string"]}
        return {"anyOf": [scalar, {"type": "array", "items": scalar, "minItems": 1}]}


def _is_scalar(value: object) -> bool:
    return isinstance(value, bool | int | float | str)


class _Selection:
    """Tells the file that is read which values of its axes are meant."""

    def check(self, value: object, info: ValidationInfo) -> object:
        """Have every value looked for among the swept ones."""
        if info.context is not None:
            info.context.check_selection(value)
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Look at the mapping before its types are checked."""
        return core_schema.with_info_before_validator_function(self.check, handler(source))


Coordinate = Annotated[Any, _Coordinate()]
Selection = Annotated[dict[AxisName, Coordinate], _Selection()]
