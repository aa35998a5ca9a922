"""The machine and the versions of a run leave, as plain data, for `env.json`. Not for the log."""

from __future__ import annotations

import os
import platform
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

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


def machine() -> dict[str, Any]:
    """Return versions, processor and where kernels are kept."""
    from lavendersim import __version__
    from lavendersim.engine.kernel_cache import directory

    kept, note = directory()
    return {
        "lavender": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
        "system": f"{platform.system()} {platform.release()}",
        "processor": processor(),
        "cores": os.cpu_count(),
        "kernel cache": note or str(kept),
    }


def kernel_files() -> list[Path]:
    """Return the compiled kernels on disk."""
    from lavendersim.engine.kernel_cache import directory

    kept = directory()[0]
    return sorted(kept.glob("*.kernel")) if kept.name else []


def environment(spec: Any) -> dict[str, Any]:
    """Return what a reader needs to judge the timings of a run and to repeat it."""
    from lavendersim.engine.kernel_cache import source_hash

    return {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        **machine(),
        "engine source": source_hash(),
        "plan": spec.digest(),
        "spec": spec._asdict(),
    }
