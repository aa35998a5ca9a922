"""Configs to begin with (`starts/`): a question each, with comments on what may be changed."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, NamedTuple

from lavendersim.durable_files import write_whole
from lavendersim.errors import UsageError
from lavendersim.quantities.found import nearest, quoted

_STARTS: Final = Path(__file__).parent / "starts"
_QUESTION: Final = re.compile(r"^question: (.+)$", re.M)
_NAME: Final = "{name}"  # in a comment of each: the file that it was written to
SUFFIXES: Final = (".yaml", ".yml")  # of what a folder of configs has


class Start(NamedTuple):
    """A config to begin with."""

    name: str  # a word
    question: str
    text: str


def starts() -> list[Start]:
    """Return all of them, by name."""
    found = []
    for file in sorted(_STARTS.glob("*.yaml")):
        text = file.read_text(encoding="utf-8")
        question = _QUESTION.search(text)
        if question is None:
            raise ValueError(f"{file}: no question")
        found.append(Start(file.stem, question[1], text))
    return found


def start_named(name: str) -> Start:
    """Return the config of a name. UsageError, with the nearest name or all, without one."""
    known = {start.name: start for start in starts()}
    if name not in known:
        raise UsageError(f"no starting config is called {quoted(name)}{nearest(name, known)}")
    return known[name]


def write_start(start: Start, path: Path) -> None:
    """Write a config to a new file. UsageError where it is there, or named like no config."""
    if path.suffix not in SUFFIXES:
        raise UsageError(f"{path}: the name of a config ends in .yaml")
    if path.exists() or path.is_symlink():
        raise UsageError(f"{path}: it is there already; name another file")
    if not path.parent.is_dir():
        raise UsageError(f"{path.parent}: no such folder")
    write_whole(path, start.text.replace(_NAME, path.name))
