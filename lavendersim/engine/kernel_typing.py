"""Types of a kernel's variables: each constraint is asked again only where a type has changed.

Numba asks all constraints of a kernel, again and again until no type changes: the last time of
them, and nearly all of the times before, for nothing. Calls of other kernels and functions of
scalars have their types at hand. Like `part_compiler` this leans on what numba keeps to itself.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from operator import getitem
from typing import Any, Final

from numba.core import errors, typeinfer, types

from .extremes import EXTREMES, extreme_of

_infer: Any = typeinfer


NEEDED: Final = (
    "Propagate", "ArgConstraint", "BuildTupleConstraint", "ExhaustIterConstraint",
    "PairFirstConstraint", "PairSecondConstraint", "GetAttrConstraint", "StaticGetItemConstraint",
    "SetAttrConstraint", "SetItemConstraint", "StaticSetItemConstraint", "CallConstraint",
    "IntrinsicCallConstraint",
)  # fmt: skip
if not all(hasattr(typeinfer, name) for name in NEEDED):
    raise ImportError("numba finds types in another way")


def _names(*variables: Any) -> list[str]:
    return [each if isinstance(each, str) else each.name for each in variables]


PROPAGATES: Final = (_infer.Propagate, _infer.GetAttrConstraint)  # and note that they did
# The variables of a constraint by its class: first the one that it gives a type, where it does.
_VARIABLES: Final[dict[type, Callable[[Any], list[str]]]] = {
    _infer.Propagate: lambda it: [it.dst, it.src],
    _infer.ArgConstraint: lambda it: [it.dst, it.src],
    _infer.BuildTupleConstraint: lambda it: _names(it.target, *it.items),
    _infer.ExhaustIterConstraint: lambda it: _names(it.target, it.iterator),
    _infer.PairFirstConstraint: lambda it: _names(it.target, it.pair),
    _infer.PairSecondConstraint: lambda it: _names(it.target, it.pair),
    _infer.GetAttrConstraint: lambda it: _names(it.target, it.value),
    _infer.StaticGetItemConstraint: lambda it: _names(
        it.target, it.value, *(it.fallback.args[1:] if it.fallback else ())
    ),
    _infer.SetAttrConstraint: lambda it: _names(it.target, it.value),
    _infer.SetItemConstraint: lambda it: _names(it.target, it.index, it.value),
    _infer.StaticSetItemConstraint: lambda it: _names(it.target, it.index_var, it.value),
    _infer.CallConstraint: lambda it: _names(
        it.target, it.func, *it.args, *(value for _, value in it.kws or ()), *_or_none(it.vararg)
    ),
    _infer.IntrinsicCallConstraint: lambda it: _names(it.target, *it.args),
}


def _or_none(variable: Any) -> tuple[Any, ...]:
    return () if variable is None else (variable,)


class _Asked:
    """A constraint, and what its variables were when it was asked last."""

    __slots__ = ("constraint", "fails", "types", "variables")

    def __init__(self, constraint: Any, typevars: Any) -> None:
        names = _VARIABLES[type(constraint)](constraint)
        self.constraint = constraint
        self.variables = [typevars[name] for name in names]
        self.types: list[Any] = []
        self.fails = False

    def ask(self, infer: Any) -> bool:
        """Ask the constraint, unless it would say what it said before; return whether it did."""
        types = [each.type for each in self.variables]
        if types == self.types:
            if isinstance(self.constraint, PROPAGATES):
                infer.refine_map[self.variables[0].var] = self.constraint
            return False
        try:
            self.constraint(infer)
            self.fails = False
        except (errors.TypingError, errors.ForceLiteralArg):
            self.fails = True  # as far as types are known by now
        self.types = types
        types[0] = self.variables[0].type
        return True


def propagate(infer: Any) -> bool:
    """Ask constraints in their order until no type changes; return whether all then hold.

    A constraint whose variables have the types that they had when it was asked last, and gave the
    first of them its own, would say the same again. Where not all hold numba says why.
    """
    constraints = infer.constraints.constraints
    if any(type(each) not in _VARIABLES for each in constraints):
        return False  # no kernel has them
    asked, again = [_Asked(each, infer.typevars) for each in constraints], True
    while again:
        again = False
        for each in asked:
            again |= each.ask(infer)
    return not any(each.fails for each in asked)


_SCALARS = types.Number, types.Boolean, types.NoneType, types.Literal
_HOLDERS = types.Record, types.BaseNamedTuple
_resolved: dict[Any, Any] = {}
_items: dict[tuple[int, int], Any] = {}  # of what is indexed by what, by numba's codes
_attributes: dict[tuple[int, str], Any] = {}  # of records and named tuples, by numba's code of both


def quick(typingctx: Any, *, direct: bool = False) -> Any:
    """Return a typing context that has the types of most that kernels do at hand.

    Numba asks some twenty templates for the type of every sum of two numbers, each time, and all
    that it knows of attributes for every field. direct: whether `KernelLower` makes the
    instructions, for which numba need not compile its own functions.
    """
    quick = copy(typingctx)

    def resolve_function_type(function: Any, args: Any, kws: Any) -> Any:
        if isinstance(function, types.Dispatcher) and hasattr(function.dispatcher, "signature_for"):
            return function.dispatcher.signature_for(args, kws)
        if function is getitem and not kws:
            place = args[0]._code, args[1]._code
            if place not in _items:
                _items[place] = typingctx.resolve_function_type(function, args, kws)
            return _items[place]
        scalar = isinstance(function, types.Function) and not kws
        if not scalar or not all(isinstance(kind, _SCALARS) for kind in args):
            return typingctx.resolve_function_type(function, args, kws)
        if direct and function.typing_key in EXTREMES:
            found = extreme_of(function.typing_key, args)
            if found is not None:
                return found
        found = _resolved.get((function, args))
        if found is None:
            found = _resolved[function, args] = typingctx.resolve_function_type(function, args, kws)
        return found

    def resolve_getattr(kind: Any, name: str) -> Any:
        code = getattr(kind, "_code", None)
        if code is None or not isinstance(kind, _HOLDERS):
            return typingctx.resolve_getattr(kind, name)
        key = code, name
        found = _attributes.get(key)
        if found is None:
            found = typingctx.resolve_getattr(kind, name)
            _attributes[key] = found
        return found

    quick.resolve_function_type = resolve_function_type
    quick.resolve_getattr = resolve_getattr
    return quick
