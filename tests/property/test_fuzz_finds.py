"""What the fuzz has found once breaks no law."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from fuzz_laws import broken

FOUND = sorted((Path(__file__).parents[2] / "configs" / "hard" / "found").glob("*.yaml"))


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_what_was_found_once_breaks_no_law(path: Path) -> None:
    tree: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert broken(tree) == []
