"""What the documents show is what lavender does: their Python runs, and prints what they print."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pytest
from sources import ROOT

DOCUMENTS = ROOT / "docs"
# A fenced block: its language, its content. Python without a `text` block behind it prints nothing
# that is shown.
BLOCK = re.compile(r"^```(?P<language>\w*)\n(?P<content>.*?)^```$", re.DOTALL | re.MULTILINE)


def examples(document: Path) -> list[tuple[str, str]]:
    """Return the Python of a document, each with the text that follows it as its output."""
    blocks = [(m["language"], m["content"]) for m in BLOCK.finditer(document.read_text())]
    found = []
    for k, (language, content) in enumerate(blocks):
        if language == "python":
            after = blocks[k + 1] if k + 1 < len(blocks) else ("", "")
            found.append((content, after[1] if after[0] == "text" else ""))
    return found


def test_reading_a_contact_prints_what_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "configs").symlink_to(ROOT / "configs")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = examples(DOCUMENTS / "read-a-contact.md")
    assert len(blocks) > 8
    for source, shown in blocks:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(source, "read-a-contact.md", "exec"), names)
        assert printed.getvalue() == shown
