"""Variables that an instruction of numba's names, which it is asked for many times.

Like `part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from typing import Any

from numba.core import ir

_VARIABLE, _INSTRUCTION, _ROW, _NAMED, _OTHER = range(5)
_kinds: dict[type, int] = {}


def _kind_of(value: type) -> int:
    """Return what holds variables of the intermediate representation; remembered by class."""
    families = enumerate((ir.Var, ir.Inst, (list, tuple), dict))
    kind = next((kind for kind, classes in families if issubclass(value, classes)), _OTHER)  # type: ignore[arg-type]
    _kinds[value] = kind
    return kind


def variables_of(value: Any) -> list[Any]:
    """Return the variables in a value, in the order of numba's own `Inst._rec_list_vars`."""
    found: list[Any] = []
    waiting = [iter((value,))]
    while waiting:
        for each in waiting[-1]:
            kind = _kinds.get(type(each))
            if kind is None:
                kind = _kind_of(type(each))
            if kind == _OTHER:
                continue
            if kind == _VARIABLE:
                found.append(each)
            elif kind == _INSTRUCTION:
                found += each.list_vars()
            else:
                waiting.append(iter(each.values() if kind == _NAMED else each))
                break
        else:
            waiting.pop()
    return found
