"""The environment says how many threads share a step."""

from __future__ import annotations

import pytest

from lavendersim.engine.team import MOST
from lavendersim.errors import UsageError
from lavendersim.runner.threads import VARIABLE, threads_asked


def test_the_environment_says_how_many_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    assert threads_asked() == 1
    for given, threads in (("3", 3), ("32", MOST), ("", 1)):
        monkeypatch.setenv(VARIABLE, given)
        assert threads_asked() == threads
    for given in ("0", "-1", "two", " ", "1.5", "33", "9" * 5000):
        monkeypatch.setenv(VARIABLE, given)
        with pytest.raises(UsageError, match="LAVENDER_THREADS: expected a whole number from 1"):
            threads_asked()
