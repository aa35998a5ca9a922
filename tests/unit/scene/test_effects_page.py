"""The page on the effects says what they declare."""

from __future__ import annotations

from pathlib import Path

from lavendersim.scene.effects_page import page

PAGE = Path(__file__).parents[3] / "docs/effects.md"


def test_the_page_on_effects_is_written_from_their_declarations() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()
