"""Logs of some hundred steps have several groups here: chunks close earlier than those of runs."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from lavendersim.trace import writer
from lavendersim.trace.encode import Streams

KIB = 1024


# Of a module: one of the package would last until the process ends, and cut the logs of others.
@pytest.fixture(scope="module", autouse=True)
def small_chunks() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        small = Streams(4096 * KIB, 1024 * KIB, 1024 * KIB, 128 * KIB)
        patch.setattr(writer, "CHUNK_BYTES", small)
        yield
