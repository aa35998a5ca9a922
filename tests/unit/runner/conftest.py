"""Processes are started where a test asks for several, as in tests/runner."""

from __future__ import annotations

from tests.runner.conftest import processes_at_once

__all__ = ["processes_at_once"]
