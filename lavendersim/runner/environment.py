"""The machine and the versions of a run leave, as plain data, for `env.json`. Not for the log."""

from __future__ import annotations

import os
import platform
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
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
    from lavendersim.engine.kernel_cache import directory

    kept, note = directory()
    return {
        "python": platform.python_version(),
        **versions(),
        "system": f"{platform.system()} {platform.release()}",
        "processor": processor(),
        "cores": os.cpu_count(),
        "kernel cache": note or str(kept),
    }


def kernel_note() -> str:
    """Return a sentence when kernels are not kept in the usual place, else nothing."""
    from lavendersim.engine.kernel_cache import directory

    return directory()[1]


def kernel_files() -> list[Path]:
    """Return the compiled kernels on disk."""
    from lavendersim.engine.kernel_cache import directory

    kept = directory()[0]
    return sorted(kept.glob("*.kernel")) if kept.name else []


def delete_kernels() -> int:
    """Delete the compiled kernels; returns how many there were."""
    files = kernel_files()
    for file in files:
        file.unlink(missing_ok=True)
    return len(files)


def environment(*specs: Spec) -> dict[str, Any]:
    """Return what a reader needs to judge the timings of a run and to repeat it."""
    from lavendersim.engine.kernel_cache import source_hash
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
