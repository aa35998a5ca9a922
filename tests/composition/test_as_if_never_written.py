"""A pruned engine has the very instructions of one whose sources never had the effect.

From a copy of the engine an effect is cut out: its file, its name in the list, and every
`if flag:` elsewhere that guards it or a term of rows that it alone brings. A new process compiles
the same plan from it, and the instructions, in their order, are those of the plan compiled from the
sources as they are.
"""

from __future__ import annotations

import ast
import dataclasses
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from lavendersim.engine.effects import EFFECTS

ROOT = Path(__file__).parents[2]
# Prints the instructions of a scene's engine, compiled anew; a cached one has no text. Operands
# are left out: they hold names, and names a counter of the process.
COMPILE = """
import json, sys
sys.path.insert(0, sys.argv[1])
from idle_scenes import SCENES
from laboratory import Bench
from lavendersim.engine import __file__ as where
from lavendersim.engine.step import make_advance

engine = Bench(SCENES["plastic balls"](), None).engine
engine._kernel = make_advance(engine.spec)
engine.advance(1)
(compiled,) = engine._kernel.overloads.values()
lines = compiled.library.get_asm_str().splitlines()
words = [line.split()[0] for line in lines if line.startswith("\\t") and line[1:2].isalpha()]
print(json.dumps({"where": where, "spec": engine.spec, "instructions": words}))
"""


def terms_of(effect: str) -> list[str]:
    """Return the terms of rows that no other effect brings."""
    (row,) = (one.row for one in EFFECTS if one.name == effect)
    others = [one.row for one in EFFECTS if one.name != effect]
    names = [term.name for term in dataclasses.fields(row) if getattr(row, term.name)]
    return [name for name in names if not any(getattr(other, name) for other in others)]


class Cut(ast.NodeTransformer):
    """Take out the branches of an effect's flags, and the flags."""

    def __init__(self, effect: str) -> None:
        asked = [(f"row_terms(spec).{term}", f"terms.{term}") for term in terms_of(effect)]
        self.asked = {f"spec.has('{effect}')", *(one for pair in asked for one in pair)}
        self.flags: set[str] = set()
        self.branches = 0

    def visit_Assign(self, node: ast.Assign) -> ast.AST | list[ast.AST]:
        self.generic_visit(node)
        if len(node.targets) > 1:
            return node
        (target,) = node.targets
        several = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
        names = target.elts if several else [target]
        values = node.value.elts if several else [node.value]
        pairs = list(zip(names, values, strict=True))
        flags = [name for name, value in pairs if ast.unparse(value) in self.asked]
        self.flags |= {name.id for name in flags}
        left = [ast.Assign([name], value) for name, value in pairs if name not in flags]
        return node if not flags else [ast.copy_location(one, node) for one in left]

    def visit_IfExp(self, node: ast.IfExp) -> ast.AST:
        """Take out what a maker makes for such branches alone: `make(spec) if flag else None`."""
        self.generic_visit(node)
        by_flag = isinstance(node.test, ast.Name) and node.test.id in self.flags
        return node.orelse if by_flag else node

    def visit_If(self, node: ast.If) -> ast.AST | None:
        if isinstance(node.test, ast.Name) and node.test.id in self.flags:
            assert not node.orelse
            self.branches += 1
            return None
        self.generic_visit(node)
        node.body = node.body or [ast.Pass()]
        return node


def cut_out(folder: Path, effect: str) -> int:
    """Cut an effect out of a copy of the engine; return how many branches it had."""
    (folder / f"effects/{effect}.py").unlink()
    listed = folder / "effects/__init__.py"
    text = listed.read_text()
    line = f'    "{effect}",\n'
    assert text.count(line) == 1
    listed.write_text(text.replace(line, ""))
    branches = 0
    for path in folder.rglob("*.py"):
        cut = Cut(effect)
        tree = cut.visit(ast.parse(path.read_text()))
        if cut.flags:
            path.write_text(ast.unparse(tree) + "\n")
            branches += cut.branches
        assert f'"{effect}"' not in path.read_text()
    return branches


def instructions(package: Path) -> list[str]:
    """Return the instructions of a frictionless scene's engine, compiled from a package."""
    done = subprocess.run(
        [sys.executable, "-P", "-c", COMPILE, str(ROOT / "tests/oracle")],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(package), str(ROOT)])},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert found["where"].startswith(str(package))
    return list(found["instructions"])


@pytest.fixture(scope="module")
def as_it_is() -> list[str]:
    found = instructions(ROOT)
    assert len(found) > 1000
    return found


@pytest.mark.parametrize(
    ("effects", "elsewhere"),
    [
        (("drag",), False),
        (("tangential_compliance", "hertz_contact", "contact_spring", "compliance"), True),
    ],
    ids=["drag", "compliance"],
)
def test_a_pruned_effect_leaves_no_instruction(
    effects: tuple[str, ...], elsewhere: bool, as_it_is: list[str], tmp_path: Path
) -> None:
    """elsewhere: whether files that are not the effect's have branches of what it alone brings."""
    without = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "lavendersim", tmp_path / "lavendersim", ignore=without)
    for effect in effects:
        assert (cut_out(tmp_path / "lavendersim/engine", effect) > 0) == elsewhere
    assert instructions(tmp_path) == as_it_is
