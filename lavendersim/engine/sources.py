"""The engine's sources as text, and their hash: what results depend on. Loads without numba."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path


@cache
def engine_sources() -> dict[str, bytes]:
    """Return every engine source by its path in the engine."""
    root = Path(__file__).parent
    return {
        path.relative_to(root).as_posix(): path.read_bytes() for path in sorted(root.rglob("*.py"))
    }


def digest(sources: dict[str, bytes]) -> str:
    """Return the sha256 of sources, by path and content."""
    found = hashlib.sha256()
    for path, source in sources.items():
        found.update(path.encode() + b"\0" + source + b"\0")
    return found.hexdigest()


@cache
def source_hash() -> str:
    """Return the sha256 of every engine source, by path and content."""
    return digest(engine_sources())
