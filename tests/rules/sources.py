"""lavender's own files and their imports, each with the package that it stands in."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
# Folder in the repository: name it is imported by.
PACKAGES = {"lavendersim": "lavendersim", "cli": "lavender_cli"}


class Import(NamedTuple):
    """One imported module, with the file that imports it."""

    file: Path  # relative to the repository
    room: str  # a folder or file of lavendersim, or `cli`
    module: str  # in full, such as lavendersim.engine.step.advance_for or numpy

    @property
    def target(self) -> str:
        """The room of ours that is imported, or the top package of someone else's."""
        parts = self.module.split(".")
        if parts[0] == "lavender_cli":
            return "cli"
        return parts[1] if parts[0] == "lavendersim" and len(parts) > 1 else parts[0]

    def __str__(self) -> str:
        return f"{self.file} imports {self.module}"


def files() -> list[Path]:
    """Return every source file of the package and the command line."""
    return [file for folder in PACKAGES for file in sorted((ROOT / folder).rglob("*.py"))]


def module_of(file: Path) -> list[str]:
    """Return the dotted name of a source file, in parts."""
    folder, *rest = file.relative_to(ROOT).with_suffix("").parts
    return [PACKAGES[folder], *rest]


def room_of(file: Path) -> str:
    """Return the room a source file belongs to."""
    package, *rest = module_of(file)
    return "cli" if package == "lavender_cli" else rest[0]


def modules(node: ast.AST, package: list[str]) -> list[str]:
    """Return what one statement imports; `package` is where its file stands."""
    if isinstance(node, ast.Import):
        return [name.name for name in node.names]
    if isinstance(node, ast.ImportFrom):
        base = package[: len(package) - node.level + 1] if node.level else []
        source = ".".join([*base, *(node.module or "").split(".")]).strip(".")
        return [f"{source}.{name.name}" for name in node.names]
    return []


@cache
def imports() -> list[Import]:
    """Return every import of every file: at the top, in functions, and for type checkers."""
    return [found for file in files() for found in imports_of(file)]


def imports_of(file: Path) -> Iterator[Import]:
    """Yield every import of one file."""
    where, room, package = file.relative_to(ROOT), room_of(file), module_of(file)[:-1]
    for node in ast.walk(ast.parse(file.read_text())):
        for module in modules(node, package):
            yield Import(where, room, module)
