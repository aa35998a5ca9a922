"""A composed kernel enters, the same kernel with its machine code kept on disk leaves.

Numba's own `cache=True` does not fit kernels made by factories: a closure over another kernel never
hits, and edited callees in other files go stale (numba issue 9483). The key here is ours: every
engine source, the spec, the options, numba's and numpy's versions, the Python, the CPU and the
signature. Whatever changes, a new file is written; nothing stale is ever loaded.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import platform
import struct
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from time import thread_time
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from .compile import OPTIONS
from .spec import Spec

DIRECTORY_VARIABLE = "LAVENDER_CACHE_DIR"


@cache
def source_hash() -> str:
    """Return the sha256 of every engine source, by path and content."""
    root = Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0")
        digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()


def _is_private(path: Path) -> bool:
    """Whether nobody else may write here: what is loaded from here is run."""
    if os.name != "posix":
        return True
    status = path.stat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022


@cache
def directory() -> tuple[Path, str]:
    """Return where kernels are kept and a sentence when that is not the usual place."""
    asked = os.environ.get(DIRECTORY_VARIABLE)
    usual = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "lavender"
    fallback = Path(tempfile.gettempdir()) / f"lavender-{os.getuid() if os.name == 'posix' else ''}"
    for path in [Path(asked)] if asked else [usual, fallback]:
        with contextlib.suppress(OSError):
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
            if _is_private(path) and os.access(path, os.W_OK):
                note = "" if path in (usual, Path(asked or "")) else f"kernels are kept in {path}"
                return path, note
    why = "no cache directory that is writable by this user alone"
    return Path(), f"{why}: kernels are compiled anew in every process"


class Compiled(NamedTuple):
    """What a kernel took to compile; kept behind its machine code."""

    seconds: float  # of the processor
    alone: bool  # the first that its process compiled: no part of it was there already


_COMPILED = struct.Struct("<d?")


class KernelCache:
    """What a numba dispatcher asks for compiled code: the part of its cache interface it calls."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        self.cache_path = directory()[0]
        self.used = ""  # key of the kernel that was loaded or compiled last
        self.hits = 0
        self.misses = 0
        self.anew = False  # true: what is kept is not loaded but compiled again
        self._began = 0.0

    saved = 0  # kernels that this process compiled

    def key(self, signature: Any, codegen: Any) -> str:
        """Return the hex name of the file for `signature` on this machine."""
        versions = (numba.__version__, np.__version__, sys.version_info[:3], platform.machine())
        parts = (
            source_hash(),
            repr(self.spec),
            sorted(OPTIONS.items()),
            versions,
            codegen.magic_tuple(),
            str(signature),
        )
        return hashlib.sha256(repr(parts).encode()).hexdigest()

    def path(self, key: str) -> Path:
        """Return the file of `key`; its name begins with the digest of the spec."""
        return self.cache_path / f"{self.spec.digest()}-{source_hash()[:8]}-{key[:24]}.kernel"

    def holds(self) -> bool:
        """Whether some compiled code of this spec and these sources is on disk."""
        return any(self.cache_path.glob(f"{self.spec.digest()}-{source_hash()[:8]}-*.kernel"))

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        """Return the compiled kernel for `signature`, or None; a damaged file counts as absent."""
        self._began = thread_time()  # numba compiles next, where there is none
        target_context.refresh()
        try:
            self.used = self.key(signature, target_context.codegen())
            stored = b"" if self.anew else self.path(self.used).read_bytes()
        except OSError:
            self.misses += 1
            return None
        checksum, payload = stored[:32], stored[32:]
        if hashlib.sha256(payload).digest() != checksum:
            self.misses += 1
            return None
        self.hits += 1
        return CompileResult._rebuild(target_context, *pickle.loads(payload))

    def compiled(self) -> Compiled | None:
        """Return what the kernel used last took to compile; None where none is kept."""
        try:
            stored = self.path(self.used).read_bytes()
        except OSError:
            return None
        return Compiled(*_COMPILED.unpack(stored[-_COMPILED.size :]))

    def save_overload(self, signature: Any, result: Any) -> None:
        """Write the compiled kernel in one move, so that no reader sees half a file."""
        took = Compiled(thread_time() - self._began, KernelCache.saved == 0)
        KernelCache.saved += 1
        if not self.cache_path.name:
            return
        # Reading a pickle ends where it ends: what follows it is not in the way.
        payload = dumps(result._reduce()) + _COMPILED.pack(*took)
        target = self.path(self.key(signature, result.codegen))
        with contextlib.suppress(OSError):  # a full or read-only disk costs time, not the run
            handle, name = tempfile.mkstemp(".unfinished.kernel", dir=self.cache_path)
            with os.fdopen(handle, "wb") as file:
                file.write(hashlib.sha256(payload).digest() + payload)
            os.replace(name, target)

    def flush(self) -> None:
        """Forget nothing: entries are never wrong, only unused."""

    def enable(self) -> None:
        """Do nothing; the cache is always on."""

    disable = enable


def cached(make: Callable[[Spec], Any], spec: Spec) -> Any:
    """Return the kernel `make` composes for `spec`, with its code kept on disk."""
    dispatcher = make(spec)
    dispatcher._cache = KernelCache(spec)
    return dispatcher
