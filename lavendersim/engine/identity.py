"""What a kernel's machine code depends on, as a digest: its bytecode and all that it names.

    identity(kernel)             of its functions: bytecode, flags and constants, kernels it calls
    seen_of(types, identity)     of its arguments: of records only the fields that are named

Two kernels with the same identity, called with arguments that look the same to them, have the same
code, whatever plan they were composed for and whatever else their records hold. Neither sees a
comment, a name of a file or a line number. Numba's own functions go by its version (`build`).
"""

from __future__ import annotations

import dis
import hashlib
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numba.core import types

from .field_places import composed_name

OURS = __name__.partition(".")[0]
STORE_BY_INDEX = dis.opmap["STORE_SUBSCR"]


class UnidentifiableError(Exception):
    """Something that machine code depends on cannot be compared by its content."""


class Identity(NamedTuple):
    """What a kernel is, apart from the types of its arguments."""

    digest: str
    names: frozenset[str]  # attributes and texts in its code and its constants, and what it calls
    stores: bool  # whether anything is written to an array by index: a whole record may be copied


class _Code(NamedTuple):
    """What the bytecode of a function says."""

    digest: str
    names: frozenset[str]  # attributes, globals and texts
    stores: bool


_identities: WeakKeyDictionary[Any, Identity] = WeakKeyDictionary()
_codes: dict[CodeType, _Code] = {}


def identity(kernel: Any) -> Identity:
    """Return the identity of a kernel; raises UnidentifiableError where it calls what has none."""
    known = _identities.get(kernel)
    if known is None:
        known = _identities[kernel] = _identity_of(kernel.py_func, how_separate(kernel))
    return known


# A part is optimised without its callers, or so that its loops are loops of vectors, too, or as
# what is seldom called: with less merged into it.
SEPARATE, IN_VECTORS, SELDOM = 1, 2, 3


def how_separate(kernel: Any) -> int:
    """Return how a kernel is optimised without its callers, 0 where it is with them."""
    return int(getattr(kernel, "separate", 0))


def _identity_of(function: Any, separate: int) -> Identity:
    code = function.__code__
    digest, names, stores = _of_code(code)
    named = f"{function.__module__}.{function.__qualname__}"  # symbols carry it
    parts = [named, digest, _of_value(function.__defaults__), f"separate {separate}"]
    values = {
        name: cell.cell_contents
        for name, cell in zip(code.co_freevars, function.__closure__ or (), strict=True)
    }
    # An attribute may have the name of a global that is not read: a digest too many is no harm, and
    # a function that is no kernel cannot be called by one.
    outside = {name: function.__globals__[name] for name in names if name in function.__globals__}
    values |= {
        name: value
        for name, value in outside.items()
        if not isinstance(value, FunctionType) and not (_is_ours(value) and not _reads(code, name))
    }
    for name in sorted(values):
        value = values[name]
        for each in _flat(value):
            if isinstance(each, str):  # the name of a field may be a constant of the kernel
                names = names | {each}
            if hasattr(each, "py_func"):
                if each.py_func is function:
                    raise UnidentifiableError(f"{function.__qualname__} calls itself")
                called = identity(each)
                names, stores = names | called.names, stores or called.stores
        parts += [name, _of_value(value)]
    return Identity(_hash("\0".join(parts)), names, stores)


def _is_ours(value: Any) -> bool:
    return isinstance(value, ModuleType) and value.__name__.startswith(f"{OURS}.")


def _reads(code: CodeType, name: str) -> bool:
    """Whether a global is read in a function, or in one inside of it."""
    inside = (each for each in code.co_consts if isinstance(each, CodeType))
    return any(
        one.opname == "LOAD_GLOBAL" and one.argval == name for one in dis.get_instructions(code)
    ) or any(_reads(each, name) for each in inside)


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _of_code(code: CodeType) -> _Code:
    known = _codes.get(code)
    if known is None:
        known = _codes[code] = _read(code)
    return known


def _read(code: CodeType) -> _Code:
    names, stores = set(code.co_names), STORE_BY_INDEX in code.co_code[::2]
    constants = []
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            inside = _of_code(constant)
            names |= inside.names
            stores = stores or inside.stores
            constants.append(inside.digest)
        else:
            names |= {text for text in _flat(constant) if isinstance(text, str)}
            constants.append(f"{type(constant).__name__} {constant!r}")
    what = (
        code.co_code,
        code.co_exceptiontable,
        code.co_argcount,
        code.co_posonlyargcount,
        code.co_kwonlyargcount,
        code.co_flags,
        code.co_names,
        code.co_varnames,
        code.co_freevars,
        code.co_cellvars,
        constants,
    )
    return _Code(_hash(repr(what)), frozenset(names), stores)


def _flat(constant: Any) -> Any:
    if isinstance(constant, tuple | frozenset):
        for each in constant:
            yield from _flat(each)
    else:
        yield constant


def _of_value(value: Any) -> str:
    """Return a text that is the same for values that compile to the same code."""
    if value is None or isinstance(value, bool | int | float | str | bytes | np.generic):
        return f"{type(value).__name__} {value!r}"
    if hasattr(value, "py_func"):
        return f"kernel {identity(value).digest}"
    if isinstance(value, tuple):
        return f"{type(value).__qualname__} ({', '.join(_of_value(each) for each in value)})"
    if isinstance(value, np.ndarray):
        return f"array {value.dtype!r} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, ModuleType):
        if _is_ours(value):
            raise UnidentifiableError(f"{value.__name__}: which of its names are used is not known")
        return f"module {value.__name__}"
    if isinstance(value, type):
        fields = getattr(value, "_fields", None)  # a NamedTuple is made by its class
        return f"class {value.__module__}.{value.__qualname__} {fields}"
    if isinstance(value, BuiltinFunctionType | np.ufunc):
        return f"function {getattr(value, '__module__', None)}.{value.__name__}"
    if type(value).__module__.startswith("numba."):  # a primitive: `build` has its source
        return f"primitive {value.__module__}.{value.__name__}"
    raise UnidentifiableError(f"{value!r} is no constant")


def seen_of(arguments: tuple[Any, ...], of: Identity, *, places: bool = True) -> str:
    """Return a text of the types of arguments: all that a kernel of that identity sees of them.

    places: whether it sees where fields of composed records lie (`field_places`).
    """
    return " ".join(_seen(kind, of, places) for kind in arguments)


def _seen(kind: Any, of: Identity, places: bool) -> str:
    if isinstance(kind, types.Record):
        composed = "" if places else composed_name(kind)
        fields = [
            f"{name}@{composed or field.offset}:{_seen(field.type, of, places)}"
            for name, field in kind.fields.items()
            if name in of.names
        ]
        size = composed or (kind.size if of.stores else "")
        return f"{{{' '.join(sorted(fields))}}}{size}{'' if kind.aligned else 'unaligned'}"
    if isinstance(kind, types.Array):
        item, record = _seen(kind.dtype, of, places), isinstance(kind.dtype, types.Record)
        composed = "" if places else composed_name(kind.dtype)
        size = kind.dtype.size if record and not composed else ""
        access = kind.ndim, kind.layout, kind.mutable, kind.aligned
        return f"[{item}]{size}{access}"
    if isinstance(kind, types.BaseTuple):
        made_by = getattr(kind, "instance_class", tuple)  # a NamedTuple has its fields' names
        inside = " ".join(_seen(each, of, places) for each in _types_in(kind))
        named = getattr(made_by, "_fields", ())
        return f"{type(kind).__name__} {made_by.__qualname__}{named}({inside})"
    plain = types.Number, types.Boolean, types.NoneType, types.Literal, types.Omitted
    if isinstance(kind, plain) or not type(kind).__module__.startswith("numba."):
        return str(kind)
    raise UnidentifiableError(f"an argument of type {kind}")


def _types_in(kind: Any) -> tuple[Any, ...]:
    """Return the types of a tuple's items."""
    return tuple(kind.types)


def is_plain(kind: Any) -> bool:
    """Whether a type is the same in every plan: no record in it."""
    if isinstance(kind, types.BaseTuple):
        return all(is_plain(each) for each in _types_in(kind))
    return not isinstance(kind, types.Record | types.Array)
