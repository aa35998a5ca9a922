"""Mutants of the engine's kernels: a sign, a factor, an index, a count or a comparison changed."""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
ENGINE = Path("lavendersim/engine")
# What steps a scene; the rest of the engine compiles, keeps and lays out.
GROUPS = {
    "step": ("step.py", "step_doubling.py", "error_estimate.py", "parts.py", "respond.py"),
    "contact": (
        *("contact.py", "cone.py", "coupling.py", "tangents.py", "stronge.py", "row_terms.py"),
        *("assemble.py", "midpoint_*.py", "impact_rows.py", "residual.py", "scaled_residual.py"),
        *("spin_block.py", "violations.py", "contact_lists.py", "flush_contacts.py"),
    ),
    "effects": ("effects/*.py",),
    "solvers": ("solvers/*.py",),
    "collide": ("collide/*.py",),
    "integrate": (
        *("integrate.py", "body_turn.py", "rotation.py", "approach.py", "impact_location.py"),
        *("foreseen_impacts.py", "spring_midpoint.py", "drives.py", "ordering.py", "vectors.py"),
        "islands.py",
    ),
}


class Mutant(NamedTuple):
    """One change of a line: a piece of the source, and what takes its place."""

    file: str  # in the engine
    line: int
    column: int
    kind: str  # sign, factor, index, count, comparison
    old: str
    new: str


def _kernels(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    """Yield functions that are compiled: those that makers define, and those marked `inner`."""
    for top in tree.body:
        if not isinstance(top, ast.FunctionDef):
            continue
        if any(isinstance(mark, ast.Name) and mark.id == "inner" for mark in top.decorator_list):
            yield top
        else:
            yield from (one for one in top.body if isinstance(one, ast.FunctionDef))


AXES = {"x": "y", "y": "z", "z": "x", "a": "b", "b": "a", "1": "2", "2": "1"}
TURNED = {ast.Lt: ">=", ast.LtE: ">", ast.Gt: "<=", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "=="}
SIGNS = {ast.Add: "-", ast.Sub: "+"}


class _Changes(ast.NodeVisitor):
    """Every change of a kernel, each within one line."""

    def __init__(self, file: str, text: str, fields: set[str]) -> None:
        self.file, self.lines, self.fields = file, text.splitlines(), fields
        self.found: list[Mutant] = []
        self._indices: set[int] = set()  # the nodes that are indices

    def _add(self, kind: str, node: ast.expr, new: str) -> None:
        old = self._text(node)
        if old and old != new:
            self.found.append(Mutant(self.file, node.lineno, node.col_offset, kind, old, new))

    def _text(self, node: ast.expr) -> str:
        """Return the source of a node; nothing where it goes over several lines."""
        line = self.lines[node.lineno - 1]
        return line[node.col_offset : node.end_col_offset] if node.lineno == node.end_lineno else ""

    def _between(self, kind: str, left: ast.expr, right: ast.expr, old: str, new: str) -> None:
        """Change the operator between two operands."""
        if left.end_lineno != right.lineno:
            return
        line = self.lines[left.end_lineno - 1]
        begin = line.find(old, left.end_col_offset, right.col_offset)
        if begin >= 0:
            self.found.append(Mutant(self.file, left.end_lineno, begin, kind, old, new))

    def visit_BinOp(self, node: ast.BinOp) -> None:
        self.generic_visit(node)
        sign = SIGNS.get(type(node.op))
        if sign:
            old = "+" if sign == "-" else "-"
            self._between("sign", node.left, node.right, old, sign)
        elif isinstance(node.op, ast.Mult | ast.Div):
            old, new = ("*", "/") if isinstance(node.op, ast.Mult) else ("/", "*")
            self._between("factor", node.left, node.right, old, new)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self.generic_visit(node)
        sign = SIGNS.get(type(node.op))
        if sign:
            old = "+=" if sign == "-" else "-="
            self._between("sign", node.target, node.value, old, sign + "=")

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        self.generic_visit(node)
        if isinstance(node.op, ast.USub) and not isinstance(node.operand, ast.Constant):
            self._add("sign", node, f"({self._text(node.operand)})")

    def visit_Compare(self, node: ast.Compare) -> None:
        self.generic_visit(node)
        turned = TURNED.get(type(node.ops[0]))
        if len(node.ops) == 1 and turned:
            sides = [ast.unparse(one) for one in (node.left, node.comparators[0])]
            self._add("comparison", node, f"{sides[0]} {turned} {sides[1]}")

    def visit_Call(self, node: ast.Call) -> None:
        self.generic_visit(node)
        if isinstance(node.func, ast.Name) and node.func.id == "range":
            *first, last = [ast.unparse(one) for one in node.args[:2]]
            rest = [ast.unparse(one) for one in node.args[2:]]
            self._add("count", node, f"range({', '.join([*first, f'({last}) - 1', *rest])})")

    def visit_Subscript(self, node: ast.Subscript) -> None:
        places = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        self._indices |= {id(place) for place in places}
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if type(node.value) is float and node.value:
            self._add("factor", node, repr(2.0 * node.value))
        elif type(node.value) is int and id(node) in self._indices and 0 <= node.value <= 2:
            # Within three: beyond the end of an array is memory of others, which no law speaks of.
            self._add("index", node, str(node.value - 1 if node.value else 1))
        elif type(node.value) is int and id(node) not in self._indices:
            self._add("count", node, str(node.value + 1))

    def visit_Attribute(self, node: ast.Attribute) -> None:
        self.generic_visit(node)
        other = AXES.get(node.attr[-1])
        if other and node.attr[:-1] + other in self.fields:
            self._add("index", node, f"{self._text(node.value)}.{node.attr[:-1]}{other}")


def mutants_of(file: str, text: str, fields: set[str]) -> list[Mutant]:
    """Return every mutant of a source of the engine."""
    changes = _Changes(file, text, fields)
    for kernel in _kernels(ast.parse(text)):
        for statement in kernel.body:
            if not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
                changes.visit(statement)
    return sorted(set(changes.found))


def groups() -> dict[str, list[Mutant]]:
    """Return every mutant, by the group that its file stands in."""
    engine = ROOT / ENGINE
    sources = {
        path.relative_to(engine).as_posix(): path.read_text() for path in engine.rglob("*.py")
    }
    fields = {
        node.attr
        for text in sources.values()
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Attribute)
    }
    found: dict[str, list[Mutant]] = {}
    for name, patterns in GROUPS.items():
        files = sorted(f for f in sources if any(fnmatch(f, pattern) for pattern in patterns))
        found[name] = [one for file in files for one in mutants_of(file, sources[file], fields)]
    return found


def drawn(count: int, seed: int, only: list[str]) -> list[Mutant]:
    """Draw so many, in turns from each group: what an interruption leaves is of all of them."""
    decks = []
    for number, mutants in enumerate(groups().values()):
        deck = [m for m in mutants if not only or any(fnmatch(m.file, p) for p in only)]
        random.Random(f"{seed} {number}").shuffle(deck)
        decks.append(deck)
    turns = max(map(len, decks))
    every = [deck[k] for k in range(turns) for deck in decks if k < len(deck)]
    return every[:count]


def applied(text: str, mutant: Mutant) -> str:
    """Return a source with the change made."""
    lines = text.splitlines(keepends=True)
    line = lines[mutant.line - 1]
    begin, end = mutant.column, mutant.column + len(mutant.old)
    assert line[begin:end] == mutant.old, mutant
    lines[mutant.line - 1] = line[:begin] + mutant.new + line[end:]
    return "".join(lines)
