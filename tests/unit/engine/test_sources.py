"""The hash of the engine's sources follows from their paths and contents, and from all of them.

That every change in the package changes it: `test_kernel_cache.py`.
"""

from __future__ import annotations

from pathlib import Path

import lavendersim.engine
from lavendersim.engine.sources import digest, engine_sources, source_hash

ENGINE = Path(lavendersim.engine.__file__).parent


def test_every_file_of_the_engine_is_a_source() -> None:
    found = engine_sources()
    assert set(found) == {str(file.relative_to(ENGINE)) for file in ENGINE.rglob("*.py")}
    assert found["sources.py"] == (ENGINE / "sources.py").read_bytes()
    assert source_hash() == digest(found)


def test_a_digest_tells_where_a_source_stands_and_where_it_ends() -> None:
    assert digest({"a": b"xy"}) != digest({"b": b"xy"})
    assert digest({"a": b"x", "b": b"y"}) != digest({"a": b"xb\0y"})
    assert digest({"a": b"x", "b": b"y"}) == digest({"a": b"x", "b": b"y"})
