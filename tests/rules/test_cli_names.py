"""What a command takes of another module of the command line is there.

The package is installed from a folder of another name, so the type checker does not follow it.
"""

from __future__ import annotations

import ast
from importlib import import_module
from pathlib import Path

import pytest

CLI = Path(__file__).parents[2] / "cli"
MODULES = sorted(path.stem for path in CLI.glob("*.py"))


def taken(module: str) -> set[tuple[str, str]]:
    """Return the names that a module takes of others of its package: (module, name)."""
    tree = ast.parse((CLI / f"{module}.py").read_text())
    names, modules = set(), {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "lavender_cli":
            modules |= {alias.asname or alias.name: alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("lavender_cli."):
            names |= {(str(node.module).partition(".")[2], alias.name) for alias in node.names}
    return names | {
        (modules[node.value.id], node.attr)
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id in modules
    }


@pytest.mark.parametrize("module", MODULES)
def test_names_of_other_modules_are_there(module: str) -> None:
    missing = [
        f"{other}.{name}"
        for other, name in sorted(taken(module))
        if not hasattr(import_module(f"lavender_cli.{other}"), name)
    ]
    assert missing == []
