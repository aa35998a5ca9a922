"""Machine code of kernels on disk, under a key of our own.

Numba's own `cache=True` does not fit kernels made by factories: a closure over another kernel never
hits, and edited callees in other files go stale (numba issue 9483). The key here is ours: every
engine source, the spec, the options, numba's settings and version, numpy's, the Python, the CPU
and the signature. Whatever changes, a new file is written; nothing stale is ever loaded. What has
not been used for longest makes room for what is new.
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
import time
from collections.abc import Callable
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
from numba.core.compiler import CompileResult
from numba.core.registry import cpu_target
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps

from .compile import OPTIONS
from .spec import Spec

DIRECTORY_VARIABLE = "LAVENDER_CACHE_DIR"
LIMIT = 400_000_000  # [byte] of all kernels kept: some six hundred, each a plan of some version
# What can be set in the environment or in a file and changes machine code. Features and name of the
# processor are asked of the code generator.
SETTINGS = (
    "OPT",
    "LOOP_VECTORIZE",
    "SLP_VECTORIZE",
    "BOUNDSCHECK",
    "DEBUGINFO_DEFAULT",
    "EXTEND_VARIABLE_LIFETIMES",
    "LLVM_REFPRUNE_PASS",
    "LLVM_REFPRUNE_FLAGS",
    "USING_SVML",
)


@cache
def source_hash() -> str:
    """Return the sha256 of every engine source, by path and content."""
    root = Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode() + b"\0")
        digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()


@cache
def _llvmlite() -> str:
    return version("llvmlite")


def build() -> str:
    """Return eight hex digits of what all kernels depend on, whatever their spec and signature."""
    parts = (
        source_hash(),
        sorted(OPTIONS.items()),
        (numba.__version__, _llvmlite(), np.__version__, sys.version_info[:3]),
        platform.machine(),
        cpu_target.target_context.codegen().magic_tuple(),
        [getattr(numba.config, name, None) for name in SETTINGS],
        # Whatever else numba is set to: a needless compilation is cheaper than a wrong kernel.
        sorted(item for item in os.environ.items() if item[0].startswith("NUMBA_")),
    )
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:8]


def _is_private(path: Path) -> bool:
    """Whether nobody else may write here: what is loaded from here is run."""
    if os.name != "posix":
        return True
    status = path.stat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022


@cache
def directory() -> tuple[Path, str]:
    """Return where kernels are kept and a sentence when that is not the usual place.

    The path is empty when there is no such place.
    """
    asked = os.environ.get(DIRECTORY_VARIABLE)
    usual = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "lavender"
    fallback = Path(tempfile.gettempdir()) / f"lavender-{os.getuid() if os.name == 'posix' else ''}"
    chosen = Path(asked) if asked else usual
    refusal = f"{chosen} cannot be written by this user alone"
    for path in [chosen] if asked else [chosen, fallback]:
        with contextlib.suppress(OSError):
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
            if _is_private(path) and os.access(path, os.W_OK):
                return path, "" if path == chosen else f"{refusal}: kernels are kept in {path}"
    return Path(), f"{refusal}: kernels are compiled anew in every process"


class Kept(NamedTuple):
    """A compiled kernel on disk."""

    path: Path
    size: int  # [byte]
    used: int  # [ns] since the epoch, when it was last written or loaded
    current: bool  # whether this version on this machine would load it


def kept_kernels() -> list[Kept]:
    """Return the compiled kernels on disk, the one used last at the end."""
    folder, own = directory()[0], build()
    found = []
    for path in folder.glob("*.kernel") if folder.name else ():
        with contextlib.suppress(OSError):  # another process may delete it at any time
            status = path.stat()
            current = path.name.split("-")[1:2] == [own]
            found.append(Kept(path, status.st_size, status.st_atime_ns, current))
    return sorted(found, key=lambda kept: (kept.used, kept.path))


def make_room() -> None:
    """Delete the kernels that were not used for longest until the others fit `LIMIT`."""
    kept = kept_kernels()
    total = sum(each.size for each in kept)
    for each in kept:
        if total <= LIMIT:
            return
        with contextlib.suppress(OSError):
            each.path.unlink()
        total -= each.size


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
        parts = (build(), repr(self.spec), codegen.magic_tuple(), str(signature))
        return hashlib.sha256(repr(parts).encode()).hexdigest()

    def path(self, key: str) -> Path:
        """Return the file of `key`; its name begins with the digest of the spec and the build."""
        return self.cache_path / f"{self.spec.digest()}-{build()}-{key[:24]}.kernel"

    def holds(self) -> bool:
        """Whether some compiled code of this spec and this build is on disk."""
        return any(self.cache_path.glob(f"{self.spec.digest()}-{build()}-*.kernel"))

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        """Return the compiled kernel for `signature`, or None; a damaged file counts as absent."""
        self._began = time.thread_time()  # numba compiles next, where there is none
        try:
            self.used = self.key(signature, target_context.codegen())
            path = self.path(self.used)
            stored = b"" if self.anew else path.read_bytes()
        except OSError:
            self.misses += 1
            return None
        checksum, payload = stored[:32], stored[32:]
        if hashlib.sha256(payload).digest() != checksum:
            self.misses += 1
            return None
        self.hits += 1
        with contextlib.suppress(OSError):  # when it was used last, whatever the disk notes itself
            os.utime(path, ns=(time.time_ns(), path.stat().st_mtime_ns))
        # Numba's own cache readies the context to compile before it loads, a quarter of a second
        # that machine code does not need; of all that, arrays passed from Python need this.
        rtsys.initialize(target_context)
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
        took = Compiled(time.thread_time() - self._began, KernelCache.saved == 0)
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
            make_room()

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
