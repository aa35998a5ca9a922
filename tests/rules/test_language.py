"""One word, one meaning: words that the glossary retired do not come back."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest
from retired_words import EVERYWHERE, LEFT, RETIRED
from sources import ROOT, files

GLOSSARY = ROOT / "docs/glossary.md"
# What speaks of old words because it must: the glossary, the history, these rules, and the reviewed
# table of renames.
ALLOWED = {
    GLOSSARY,
    ROOT / "CHANGELOG.md",
    Path(__file__),
    Path(__file__).with_name("retired_words.py"),
    ROOT / "tests/pinned/renames.json",
    ROOT / "lavendersim/experiment/text/former.py",  # reads keys of former versions,
    ROOT / "lavendersim/runner/run_tables.py",  # results,
    ROOT / "lavendersim/trace/schema.py",  # and logs
}
ENDINGS = {".py", ".yaml", ".md", ".expected", ".html", ".json", ".toml", ".patch"}


def place_of(file: Path) -> str:
    """Return the package, or the folder of the repository, that a file belongs to."""
    first, *rest = file.relative_to(ROOT).parts
    if first == "lavendersim":
        return rest[0] if len(rest) > 1 else "lavendersim"
    return first if rest else "docs"  # README.md and its like


@cache
def texts() -> list[tuple[str, Path, str]]:
    """Return every text of the project: its place, its file, and itself as it is searched."""
    folders = ["lavendersim", "cli", "configs", "docs", "tests"]
    found = [file for folder in folders for file in sorted((ROOT / folder).rglob("*"))]
    found += sorted(ROOT.glob("*.md"))
    return [
        (place_of(file), file, file.read_text().lower().replace("_", " "))
        for file in found
        if file.suffix in ENDINGS and file.is_file() and file not in ALLOWED
    ]


@pytest.mark.parametrize("word", RETIRED)
def test_a_retired_word_does_not_come_back(word: str) -> None:
    pattern, now, where = RETIRED[word]
    lines: dict[str, list[str]] = {}
    for place, file, text in texts():
        if place in where and re.search(pattern, text):  # few have it: lines are looked at of those
            for number, line in enumerate(text.splitlines(), start=1):
                if re.search(pattern, line):
                    lines.setdefault(place, []).append(f"{file.relative_to(ROOT)}:{number}")
    most = LEFT.get(word, {})
    more = {place: found for place, found in lines.items() if len(found) > most.get(place, 0)}
    assert more == {}, f"say {now}"


def test_every_place_is_searched() -> None:
    assert {place for place, _, _ in texts()} <= set(EVERYWHERE)


def test_a_module_says_what_it_is_first() -> None:
    """Not 'X enters, Y leaves': that hides what the module is."""
    found = []
    for file in [*files(), *sorted((ROOT / "tests").rglob("*.py"))]:
        first = (ast.get_docstring(ast.parse(file.read_text())) or "").partition("\n")[0]
        if re.search(r"\b(enters?|in)\b.*(\bleaves?\b|, out\.)", first):
            found.append(str(file.relative_to(ROOT)))
    assert found == []


# Classes of one name that mean one thing in two forms, or that a library or a config names so.
NAMESAKES = {
    "Cell": "in measures.interfaces the type of it alone",
    "Trace": "in measures.interfaces the type of it alone",
    "Column": "of a record, as an effect declares it and as a log numbers it",
    "FreeRotation": "the closed form, and the panel that draws it",
    "Ratio": "a number of a config, a kind of measure, a kind of judgement",
    "World": "what every adapter is, and each of them",
    "Scene": "as written, and as the engine takes it",
}


def test_no_two_classes_share_a_name() -> None:
    """Five classes were once called Part: who reads a name must not ask which."""
    places: dict[str, list[str]] = defaultdict(list)
    for file in files():
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(f"{file.relative_to(ROOT)}:{node.lineno}")
    shared = {name: found for name, found in places.items() if len(found) > 1}
    assert {name: found for name, found in shared.items() if name not in NAMESAKES} == {}
    assert shared.keys() == NAMESAKES.keys()


def test_a_part_is_that_of_a_compound() -> None:
    """Five classes were once called so."""
    parts = [
        str(file.relative_to(ROOT))
        for file in files()
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.ClassDef) and node.name == "Part"
    ]
    assert parts == ["lavendersim/experiment/models/shapes.py"]
