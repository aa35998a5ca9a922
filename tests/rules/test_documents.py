"""What the documents show is what lavender does: their Python runs, and prints what they print."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pytest
from sources import ROOT
from tables import PAGES, made
from typer.main import get_group as click_group

from lavender_cli.main import app
from lavendersim.engine.solvers import SOLVER_NAMES

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


@pytest.mark.parametrize("name", ["read-a-contact.md", "laws.md", "python.md", "tables.md"])
def test_a_document_prints_what_it_shows(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "configs").symlink_to(ROOT / "configs")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = examples(DOCUMENTS / name)
    assert blocks
    for source, shown in blocks:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(source, name, "exec"), names)
        assert printed.getvalue() == shown


def test_every_command_is_documented() -> None:
    """And none that is not there."""
    found = set(re.findall(r"\blavender (\w+)", (DOCUMENTS / "commands.md").read_text()))
    assert found - {"installed"} == set(click_group(app).commands)


@pytest.mark.parametrize("page", sorted(ROOT.glob("*.md")), ids=lambda page: page.name)
def test_links_of_pages_outside_of_the_site_lead_somewhere(page: Path) -> None:
    """Those of the site are checked when it is built."""
    targets = re.findall(r"\]\((?!https?:)([^)#]+)(?:#([^)]+))?\)", page.read_text())
    for target, anchor in targets:
        file = page.parent / target
        assert file.exists(), target
        if anchor:
            heads = re.findall(r"^#+ (.+)$", file.read_text(), re.MULTILINE)
            slugs = [re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-") for head in heads]
            assert anchor in slugs, f"{target}#{anchor}"


@pytest.mark.parametrize("name", PAGES)
def test_tables_of_the_documents_are_those_of_the_code(name: str) -> None:
    """They are written anew by `python tests/rules/tables.py`."""
    assert (DOCUMENTS / name).read_text() == made(name)


@pytest.mark.parametrize("page", ["theory.md", "solvers.md"])
def test_every_solver_is_written_down(page: str) -> None:
    text = (DOCUMENTS / page).read_text()
    assert [name for name in SOLVER_NAMES if f"`{name}`" not in text] == []


def test_every_module_of_the_engine_is_on_the_page() -> None:
    text = (DOCUMENTS / "architecture.md").read_text()
    modules = [file.name for file in sorted((ROOT / "lavendersim/engine").glob("*.py"))]
    assert [name for name in modules if name != "__init__.py" and f"`{name}`" not in text] == []
