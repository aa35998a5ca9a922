"""Processes are started where a test asks for several, however little there is to do."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from lavendersim.runner import executor


# Of a module: one of the session would last until the process ends, in the tests of other folders.
@pytest.fixture(autouse=True, scope="module")
def processes_at_once() -> Iterator[None]:
    """Let no sweep be too small for the processes that it asks for."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(executor, "WORTH_PROCESSES", -1.0)
        yield
