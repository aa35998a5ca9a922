"""Machine code of whole kernels on disk, under a key of all that it depends on.

Numba's own `cache=True` does not fit kernels made by factories: a closure over another kernel never
hits, and edited callees in other files go stale (numba issue 9483). The key here is what the code
depends on: the kernel's identity, the types of its arguments, and `build`. Whatever of it changes,
a new file is written; nothing stale is ever loaded.
"""

from __future__ import annotations

import pickle
import struct
import time
from collections.abc import Callable, Container
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from llvmlite import binding as llvm
from numba.core.compiler import CompileResult
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from . import kernel_store
from .compile_lock import CompileLock
from .compile_options import build
from .identity import UnidentifiableError, identity
from .kernel_parts import STORE, key_of
from .spec import Spec


class Compiled(NamedTuple):
    """What a kernel took to compile; kept behind its machine code."""

    seconds: float  # of the processor
    alone: bool  # no part of it was there already


_COMPILED = struct.Struct("<d?")


class KernelCache:
    """What a numba dispatcher asks for compiled code: the part of its cache interface it calls."""

    def __init__(self, spec: Spec, kernel: Any) -> None:
        self.spec, self.kernel = spec, kernel
        self.cache_path = kernel_store.directory()[0]
        self.used = ""  # key of the kernel that was loaded or compiled last
        self.hits = 0
        self.misses = 0
        self.anew = False  # true: what is kept is not loaded but compiled again, with all its parts
        self._began = 0.0
        self._lock = CompileLock()

    def _name(self) -> str:
        """Return what names of files begin with, whatever the types of the arguments."""
        try:
            own = identity(self.kernel).digest[:8]
        except UnidentifiableError:
            return ""
        return f"{self.spec.digest()}-{build()}-{own}"

    def key(self, signature: Any) -> str:
        """Return the hex name of the code for `signature` on this machine; "": it has none."""
        return key_of(self.kernel, tuple(signature))

    def path(self, key: str) -> Path:
        """Return the file of `key`."""
        return self.cache_path / f"{self._name()}-{key[:24]}{kernel_store.KERNEL}"

    def is_of(self, names: Container[str]) -> bool:
        """Whether code of this kernel and this build is among `kernel_store.kernels_on_disk`."""
        return self._name() in names

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        """Return the compiled kernel for `signature`, or None; a damaged file counts as absent."""
        self._began = time.thread_time()  # numba compiles next, where there is none
        STORE.begin(self.anew)
        self.used = self.key(signature)
        kept = self.used and self.cache_path.name and not self.anew
        payload = kernel_store.read(self.path(self.used)) if kept else None
        if payload is None and kept:
            self._lock.take(self.cache_path, self.used)
            payload = kernel_store.read(self.path(self.used))  # another process may have made it
        if payload is None:
            self.misses += 1
            return None
        self._lock.release()
        self.hits += 1
        from .separate_code import load  # late: nothing is kept where parts are not compiled

        # Numba's own cache readies the context to compile before it loads, a quarter of a second
        # that machine code does not need; of all that, arrays passed from Python need this.
        _name_helpers(target_context)
        separate, kernel = pickle.loads(payload)
        load(separate, target_context.codegen())
        return CompileResult._rebuild(target_context, *kernel)

    def compiled(self) -> Compiled | None:
        """Return what the kernel used last took to compile; None where none is kept."""
        payload = kernel_store.read(self.path(self.used))
        return Compiled(*_COMPILED.unpack(payload[-_COMPILED.size :])) if payload else None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Write the compiled kernel in one move, so that no reader sees half a file."""
        took = Compiled(time.thread_time() - self._began, STORE.alone)
        STORE.begin(anew=False)
        if self.cache_path.name and self.used:
            # Reading a pickle ends where it ends: what follows it is not in the way.
            kernel = result.library.separate, result._reduce()
            payload = dumps(kernel) + _COMPILED.pack(*took)
            kernel_store.write(self.path(self.used), payload)
        self._lock.release()

    def flush(self) -> None:
        """Forget nothing: entries are never wrong, only unused."""

    def enable(self) -> None:
        """Do nothing; the cache is always on."""

    disable = enable


@cache
def _name_helpers(target_context: Any) -> None:
    """Let code that is loaded call what numba has for arrays of Python.

    Numba would compile its count of references first, which such code brings along.
    """
    try:
        from numba.core.runtime._nrt_python import c_helpers
    except ImportError:
        rtsys.initialize(target_context)
        return
    for name, address in c_helpers.items():
        llvm.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)


def cached(make: Callable[[Spec], Any], spec: Spec) -> Any:
    """Return the kernel `make` composes for `spec`, with its code kept on disk."""
    dispatcher = make(spec)
    dispatcher._cache = KernelCache(spec, dispatcher)
    return dispatcher
