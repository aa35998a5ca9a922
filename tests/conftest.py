"""Shared by all tests: pytest's own test harness, and a small experiment."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.drop_config import DROP

pytest_plugins = ["pytester"]


@pytest.fixture
def drop(tmp_path: Path) -> Path:
    """A ball from 0.1 m at e = 0.5: the ideal apex is 0.025 m."""
    path = tmp_path / "drop.yaml"
    path.write_text(DROP)
    return path
