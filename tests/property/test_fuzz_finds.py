"""What the fuzz has found once breaks no law.

What was found on an engine that the fullest one has all of is asked there, in `test_fuzz.py`.
"""

from __future__ import annotations

from typing import Any

import pytest
from fuzz_laws import broken
from fuzz_scenes import FULL, found_once

FOUND = found_once()
ELSEWHERE = {name: tree for name, tree in FOUND.items() if not FULL.has_all_of(tree)}


@pytest.mark.parametrize("tree", ELSEWHERE.values(), ids=ELSEWHERE)
def test_what_was_found_once_breaks_no_law(tree: dict[str, Any]) -> None:
    assert broken(tree) == []


def test_finds_are_asked_on_one_engine_or_the_other() -> None:
    assert 2 <= len(ELSEWHERE) <= len(FOUND) - 2
