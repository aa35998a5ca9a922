"""The machine and the versions of a run, as plain data for `env.json`; never for the log."""

from __future__ import annotations

import os
import platform
import shlex
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from lavendersim.engine.kernel_store import Kept
    from lavendersim.engine.spec import Spec

PACKAGES = ("numpy", "numba", "llvmlite", "mcap", "pydantic", "zstandard", "protobuf")


def processor() -> str:
    """Return the processor's name as the system gives it."""
    try:
        with open("/proc/cpuinfo") as lines:
            for line in lines:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


@cache
def versions() -> dict[str, str]:
    """Return the versions that the bytes of a log may depend on."""
    from lavendersim import __version__

    return {"lavender": __version__, **{name: version(name) for name in PACKAGES}}


def machine() -> dict[str, Any]:
    """Return versions, processor and where kernels are kept."""
    from lavendersim.engine.kernel_store import directory

    kept, note = directory()
    return {
        "python": platform.python_version(),
        **versions(),
        "system": f"{platform.system()} {platform.release()}",
        "processor": processor(),
        "cores": os.cpu_count(),
        "kernel cache": note or str(kept),
    }


def kernel_place() -> str:
    """Return how often kernels are compiled and where they are kept, in words."""
    from lavendersim.engine.kernel_store import directory

    kept, note = directory()
    return f"once; {note or f'kept in {kept}'}" if kept.name else note


class Kernels(NamedTuple):
    """Compiled kernels on disk: how many, and their size [byte]."""

    files: int
    size: int

    @classmethod
    def of(cls, kept: Iterable[Kept]) -> Kernels:
        """Count kernels."""
        sizes = [each.size for each in kept]
        return cls(len(sizes), sum(sizes))

    def __str__(self) -> str:
        return f"{self.files} file{'' if self.files == 1 else 's'}, {self.size / 1e6:.1f} MB"


def kernels(current: bool) -> Kernels:
    """Return what is kept of this version on this machine, or of all others."""
    from lavendersim.engine.kernel_store import kept_kernels

    return Kernels.of(each for each in kept_kernels() if each.current == current)


def kernel_limit() -> int:
    """Return the size [byte] above which kernels that were not used for longest are deleted."""
    from lavendersim.engine.kernel_store import LIMIT

    return LIMIT


class Deleted(NamedTuple):
    """What was deleted, and why the rest was not."""

    kernels: Kernels
    left: Kernels
    why: str  # of the first that is left, by the system


def delete_kernels(current: bool) -> Deleted:
    """Delete the compiled kernels of other versions, with `current` this one's.

    Not those that the system will not let go: of a disk that can only be read, say.
    """
    from lavendersim.engine.kernel_store import kept_kernels

    deleted, left, why = [], [], ""
    for each in (one for one in kept_kernels() if one.current == current):
        try:
            each.path.unlink(missing_ok=True)
        except OSError as error:
            left.append(each)
            why = why or error.strerror or str(error)
        else:
            deleted.append(each)
    return Deleted(Kernels.of(deleted), Kernels.of(left), why)


def about(arguments: Sequence[str]) -> dict[str, str]:
    """Return when, with what, where and by which arguments something was made, in words."""
    known = machine()
    names = ("lavender", "numba", "numpy")
    return {
        "made": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "versions": ", ".join(f"{name} {known[name]}" for name in names)
        + f", Python {known['python']}",
        "machine": f"{known['processor']}, {known['cores']} cores, {known['system']}",
        "command": shlex.join(["lavender", *arguments]),
    }


def environment(*specs: Spec) -> dict[str, Any]:
    """Return what a reader needs to judge the timings of a run and to repeat it."""
    from lavendersim.engine.sources import source_hash
    from lavendersim.engine.step import advance_for

    return {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        **machine(),
        "engine source": source_hash(),
        "kernels": [
            {
                "plan": spec.digest(),
                "kernel": advance_for(spec)._cache.used,
                "spec": spec._asdict(),
            }
            for spec in specs
        ],
    }
