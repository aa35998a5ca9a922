"""`min` and `max` of a few numbers: a comparison and a choice for each.

Numba compiles a function of its own for each number and type of arguments, and calls that. Like
`part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, Final

from numba.core import types
from numba.core.typing.templates import signature

EXTREMES: Final = {min: "<", max: ">"}  # how what replaces the one before compares with it
_NUMBERS = types.float64, types.int64


def extreme_of(function: Any, kinds: Sequence[Any]) -> Any:
    """Return numba's signature of `min` or `max` of numbers of one type; None of any others."""
    return _signature(function, tuple(kinds))


@cache
def _signature(function: Any, kinds: tuple[Any, ...]) -> Any:
    plain = [types.unliteral(kind) for kind in kinds]
    if len(plain) < 2 or plain[0] not in _NUMBERS or any(kind != plain[0] for kind in plain):
        return None
    return signature(plain[0], *plain)


def extreme(builder: Any, function: Any, kind: Any, values: Sequence[Any]) -> Any:
    """Return the least or the greatest of values, as Python finds it.

    A value replaces the one before only where it is less, or greater: what is no number is none.
    """
    compared = EXTREMES[function]
    best = values[0]
    for value in values[1:]:
        if kind == types.float64:
            replaces = builder.fcmp_ordered(compared, value, best)
        else:
            replaces = builder.icmp_signed(compared, value, best)
        best = builder.select(replaces, value, best)
    return best
