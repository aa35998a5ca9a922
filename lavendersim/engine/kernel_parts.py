"""Parts of kernels: each one compiled once, to LLVM's bitcode, for every plan that has it.

A part is a kernel that kernels call, for arguments of given types. Its key says what its code
depends on (`identity`), whatever plan it was composed for; its symbol carries the key, so that code
from different processes meets under the same name only where it is the same (numba numbers its
symbols by process, and the first one loaded is used: numba issue 10486). A part holds no code of
the parts it calls: a whole kernel links each of them once, and optimises them together.
"""

from __future__ import annotations

import hashlib
import itertools
import pickle
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from llvmlite.binding import Linkage, parse_bitcode

from . import kernel_store
from .compile_options import build
from .identity import UnidentifiableError, identity, is_plain, seen_of

PART, OBJECT = ".part", ".object"
_unnamed = itertools.count()


class KernelPart:
    """Code of a kernel that other kernels call; numba takes it for a library to be linked."""

    def __init__(
        self,
        symbol: str,
        returns: Any,
        bitcode: bytes,
        called: tuple[KernelPart, ...],
        key: str,
        raises: bool,
        *,
        places: tuple[str, ...] = (),
        separate: int = 0,
    ) -> None:
        self.symbol, self.returns, self.bitcode, self.called = symbol, returns, bitcode, called
        self.key = key  # names the file it is kept in; empty where it has none
        self.raises = raises  # whether it may return with an exception
        self.places = places  # of fields that its own code reads or writes (`field_places`)
        # Whether, and how, it is optimised without its callers; none whose code cannot be kept is.
        self.separate = separate if key and is_plain(returns) else 0
        self._reload_init: set[Any] = set()

    def _ensure_finalized(self) -> None:
        """Have nothing to do: what numba asks of a library before it is linked."""

    def _get_module_for_linking(self) -> Any:
        """Return the part with all that it calls, for a function of numba's that calls it."""
        module = parse_bitcode(self.bitcode)
        for part in with_called(self.called):
            if part.symbol != self.symbol:
                module.link_in(parse_bitcode(part.bitcode))
        for function in module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = Linkage.linkonce_odr
        return module


def with_called(
    parts: Iterable[KernelPart], through: Callable[[KernelPart], bool] = lambda part: True
) -> Iterator[KernelPart]:
    """Yield parts and all that they call, each once, in an order that follows from their code.

    through: whether what a part calls is yielded for it. One symbol is one code, however often it
    was compiled.
    """
    seen: set[str] = set()
    waiting = list(parts)[::-1]
    while waiting:
        part = waiting.pop()
        if part.symbol not in seen:
            seen.add(part.symbol)
            yield part
            if through(part):
                waiting += part.called[::-1]


def merged_into(parts: Iterable[KernelPart]) -> Iterator[KernelPart]:
    """Yield of `with_called` what a caller is optimised with, and the separate parts it calls."""
    yield from with_called(parts, lambda part: not part.separate)


def separate_in(parts: Iterable[KernelPart]) -> Iterator[KernelPart]:
    """Yield of `with_called` the separate parts."""
    yield from (part for part in with_called(parts) if part.separate)


def key_of(kernel: Any, arguments: tuple[Any, ...], *, places: bool = True) -> str:
    """Return 32 hex digits of what a kernel's code depends on; "" where that is not known.

    places: whether on the places of fields in composed records, as a whole kernel's does.
    """
    try:
        of = identity(kernel)
        text = f"{build()} {of.digest} {seen_of(arguments, of, places=places)}"
    except UnidentifiableError:
        return ""
    return hashlib.sha256(text.encode()).hexdigest()[:32]


class PartStore:
    """Parts of this process and, by files, of all that share the directory of kernels."""

    def __init__(self) -> None:
        self._parts: dict[str, KernelPart] = {}
        self._new: set[str] = set()  # compiled since `begin`
        self._codes: dict[str, Any] = {}  # object code of separate parts
        self._new_codes: set[str] = set()
        self._anew = False
        self.alone = True  # whether no part was found since `begin` that was there before

    def begin(self, anew: bool) -> None:
        """Begin a kernel; with `anew` what is there is not used but compiled again."""
        self._new, self._anew, self.alone = set(), anew, True
        self._new_codes = set()

    def find(self, key: str) -> KernelPart | None:
        """Return the part of a key, from this process or from disk."""
        if key in self._new:
            return self._parts[key]
        part = None if self._anew or not key else self._parts.get(key) or self._load(key)
        if part is not None:
            self.alone = False
        return part

    def keep(self, part: KernelPart) -> None:
        """Remember a part that was just compiled, here and on disk."""
        # A record that is returned would have to be each caller's own, with all its fields.
        if not part.key or not is_plain(part.returns):
            return
        self._parts[part.key] = part
        self._new.add(part.key)
        if kernel_store.directory()[0].name:
            keys = tuple(called.key for called in part.called)
            code = zlib.compress(part.bitcode, 1)
            more = part.raises, part.places, part.separate
            stored = part.symbol, part.returns, code, keys, *more
            kernel_store.write(_path(part.key), pickle.dumps(stored))

    def code(self, key: str) -> Any:
        """Return the object code of a separate part, from this process or from disk, or None."""
        if key in self._codes and (key in self._new_codes or not self._anew):
            return self._codes[key]
        kept = kernel_store.directory()[0].name and not self._anew
        payload = kernel_store.read(_path(key, OBJECT)) if kept else None
        if payload is None:
            return None
        self._codes[key] = pickle.loads(payload)
        return self._codes[key]

    def keep_code(self, key: str, code: Any) -> None:
        """Remember the object code of a separate part, here and on disk."""
        self._codes[key] = code
        self._new_codes.add(key)
        if kernel_store.directory()[0].name:
            kernel_store.write(_path(key, OBJECT), pickle.dumps(code))

    def _load(self, key: str) -> KernelPart | None:
        """Return a part from disk with all that it calls; None where any of it is missing."""
        payload = kernel_store.read(_path(key)) if kernel_store.directory()[0].name else None
        if payload is None:
            return None
        symbol, returns, bitcode, keys, raises, places, separate = pickle.loads(payload)
        called = []
        for name in keys:
            part = self._parts.get(name) or self._load(name)
            if part is None:
                return None
            called.append(part)
        code = zlib.decompress(bitcode)
        whole = KernelPart(
            symbol, returns, code, tuple(called), key, raises, places=places, separate=separate
        )
        self._parts[key] = whole
        return whole


STORE = PartStore()


def _path(key: str, kind: str = PART) -> Path:
    return kernel_store.directory()[0] / f"{build()}-{key}{kind}"


def symbol_of(function: Any, key: str) -> str:
    """Return a symbol for a part: readable, and of no other code."""
    return f"{function.__module__}.{function.__qualname__}_{key or f'unnamed{next(_unnamed)}'}"
