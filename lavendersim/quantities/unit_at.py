"""The unit of a number of a config, by its path: that which its model declares."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, get_args

from pydantic import BaseModel

from .quantity import Quantity, Vector


def unit_at(model: BaseModel, path: str) -> str:
    """Return the unit of what stands at a path such as `scene.bodies.ball.mass`; empty without.

    model: a config in which it stands.
    """
    at: Any = model
    declared: list[Any] = []
    for name in path.split("."):
        if isinstance(at, BaseModel):
            info = type(at).model_fields.get(name)
            if info is None:
                return ""
            declared = [*info.metadata, info.annotation]
            at = getattr(at, name)
        elif isinstance(at, Mapping) and name in at:
            at = at[name]
        elif name.isdecimal():  # of a list, or a component of a vector that may be none
            at = at[int(name)] if isinstance(at, Sequence) and int(name) < len(at) else None
        else:
            return ""
    return next(_units(declared), "")


def _units(declared: Iterable[Any]) -> Any:
    """Yield the units of quantities in annotations, and within these."""
    for one in declared:
        if isinstance(one, Quantity):
            yield one.unit
        elif isinstance(one, Vector):
            yield one.item.unit
        else:
            yield from _units(getattr(one, "__metadata__", ()))
            yield from _units(get_args(one))
