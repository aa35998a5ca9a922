"""What is in the machine code of a compiled engine: which kernels, and its size.

Numba leaves one symbol (`NumbaEnv`) in the object code for every function that was linked into it,
whether or not the function was inlined: what has none was never compiled. The object code is what
runs, and what is kept on disk; both are read alike.
"""

from __future__ import annotations

import pickle
import re
from collections.abc import Iterator
from hashlib import sha256
from typing import Any, NamedTuple

from llvmlite.binding import ObjectFileRef

from lavendersim.engine.engine import Engine

LOCALS = "_3clocals_3e"  # mangled, between a maker and its kernel
KEY = re.compile(r"_[0-9a-f]{32}(_\d+)?$")  # what tells parts of one name apart


class Code(NamedTuple):
    """What an engine's kernel was compiled to."""

    kernels: set[tuple[str, str]]  # (module of the engine, name) of those made for the spec
    size: int  # of the machine code [bytes]

    def of(self, effect: str) -> set[tuple[str, str]]:
        """Return the kernels of an effect's module."""
        return {kernel for kernel in self.kernels if kernel[0] == f"effects.{effect}"}


def _parts(symbol: str) -> list[str]:
    """Return the parts of a mangled name; each is preceded by its length."""
    parts, rest = [], symbol
    while found := re.match(r"\d+", rest):
        end = found.end() + int(found.group())
        parts.append(rest[found.end() : end])
        rest = rest[end:]
    return parts


def _object_codes(engine: Engine) -> list[bytes]:
    """Return the object code of the kernel, and that of its separate parts."""
    (compiled,) = engine._kernel.overloads.values()
    if compiled.library._compiled_object:
        separate, code = compiled.library.separate, compiled.library._compiled_object
    else:
        # Loaded: what was kept holds a checksum, the separate parts, and then a library, as
        # (name, kind, (code, bitcode)).
        kept = engine._kernel._cache
        payload = pickle.loads(kept.path(kept.used).read_bytes()[32:])
        separate, ((_, _, (code, _)), *_) = payload
    return [bytes(code), *separate.values()]


def _sections(engine: Engine) -> Iterator[Any]:
    for code in _object_codes(engine):
        yield from ObjectFileRef.from_data(code).sections()


def text_of(engine: Engine) -> str:
    """Return the sha256 of an engine's instructions; without the names of symbols."""
    texts = (part.data() for part in _sections(engine) if part.is_text())
    return sha256(b"".join(texts)).hexdigest()


def code_of(engine: Engine) -> Code:
    """Read the object code of an engine that has made a step."""
    kernels, size = set(), 0
    for section in _sections(engine):
        size += section.size() if section.is_text() else 0
        if section.name() == b".strtab":
            for symbol in re.findall(r"_ZN08NumbaEnv(\w+)", section.data().decode("latin-1")):
                package, room, *parts = _parts(symbol)
                if (package, room) == ("lavendersim", "engine") and LOCALS in parts:
                    place = ".".join(parts[: parts.index(LOCALS) - 1])
                    kernels.add((place, KEY.sub("", parts[-1])))
    return Code(kernels, size)
