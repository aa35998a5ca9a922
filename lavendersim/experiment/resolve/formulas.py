"""Constants and formulas of a config: from `2 * $r` to the number, at the place of the text.

    constants: {r: 0.05, slope: 0.3}
    scene: {bodies: {ball: {shape: {kind: sphere, radius: $r}, position: [0, 0, 2 * $r]}}}

A constant that an axis varies has a number in each cell alone: what takes it stays text until the
cell's value stands in `constants`. An expected value, and the ideal of a figure, may take axes too;
constants are written into its text as numbers, those that are swept as their axes, and the axes are
left to each cell.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Final, NamedTuple

from lavendersim.experiment.models.axis import axis_paths
from lavendersim.experiment.models.tree import products, swept_values
from lavendersim.experiment.text.node import BROKEN, Mark, Node, Path, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.formula import Exact, Formula, FormulaError, is_formula, read_formula
from lavendersim.quantities.found import nearest, quoted
from lavendersim.quantities.scalars import Ratio, exact

CONSTANTS: Final = "constants"
# The sections that each cell reads anew; a constant that is swept means something in them alone.
OF_CELLS: Final = (
    CONSTANTS,
    "scene",
    "events",
    "numerics",
    "duration",
    "record",
    "effects",
    "study",
)
_WORDS: Final = ("question", "expected", "extends")  # sections of text
# Keys of text that people read, in which a $ is a dollar or begins mathematics.
_LABELS: Final = ("title", "caption", "label", "series_label", "x_label", "y_label")
_TEXT_KEYS: Final = frozenset({*_LABELS, "name", "fails", "path", "meaning", "function"})


class Computed(NamedTuple):
    """A number of a config that a formula gave."""

    path: str
    text: str  # the formula, as written
    number: float
    mark: Mark


def with_numbers(root: Node, report: Report) -> tuple[Node, list[Computed]]:
    """Return the tree with numbers for formulas, and these; notes those that have none.

    What takes a swept constant stays as it is in the sections of cells, and is refused elsewhere.
    """
    pass_ = _Pass(root, _swept_constants(root), report)
    return pass_.tree(root), pass_.computed


def with_numbers_of_cell(root: Node, report: Report) -> tuple[Node, list[Computed]]:
    """Return the tree of a cell, whose constants all have numbers, with numbers for formulas."""
    pass_ = _Pass(root, {}, report)
    return pass_.tree(root, OF_CELLS), pass_.computed


def used_constants(root: Node) -> set[str]:
    """Return the names of the constants that some formula takes, or an axis is named after."""
    used: set[str] = set()
    names = root.get(CONSTANTS).entries

    def note(path: Path, node: Node) -> Node:
        if is_formula(node.text or "", names):
            with suppress(FormulaError):  # refused where it stands
                used.update(read_formula(node.text or "").names)
        return node

    _walk(root, (), note)
    return used


class _SweptBy(NamedTuple):
    """The axis that varies a constant, and whether its coordinate is the constant's value."""

    axis: str
    named: bool


def _swept_constants(root: Node) -> dict[str, _SweptBy]:
    """Return what varies each constant that is swept."""
    swept: dict[str, _SweptBy] = {}
    for product in products(root):
        for axis, node in product.entries.items():
            own = list(node.get("paths").entries)
            for path in axis_paths(node):
                if path.startswith(f"{CONSTANTS}."):
                    named = path in own[:1] or path not in own
                    swept[path.removeprefix(f"{CONSTANTS}.")] = _SweptBy(axis, named)
    return swept


def _key_of_cells(path: Path) -> str:
    """Return the key whose value may take axes, where a path is that of such a value."""
    keys = [step for step in path if isinstance(step, str)]
    if keys[0] == "expect" and keys[1:] in (["equals"], ["equals", "value"]):
        return "equals"
    return "ideal" if keys[0] == "figure" and keys[-2:] == ["ideal", "value"] else ""


def _walk(node: Node, path: Path, visit: Callable[[Path, Node], Node]) -> Node:
    """Return the tree with what `visit` returns for each text; the same node if nothing changed."""
    content = node.content
    if isinstance(content, str):
        return visit(path, node)
    if isinstance(content, tuple):
        items = tuple(_walk(item, (*path, k), visit) for k, item in enumerate(content))
        changed = any(new is not old for new, old in zip(items, content, strict=True))
        return replace(node, content=items) if changed else node
    if not isinstance(content, dict):
        return node
    entries = {
        key: below
        if key in _TEXT_KEYS or (not path and key in _WORDS)
        else _walk(below, (*path, key), visit)
        for key, below in content.items()
    }
    changed = any(entries[key] is not old for key, old in content.items())
    return replace(node, content=entries) if changed else node


class _Pass:
    """One pass over a tree. swept: the axis of each constant that has no number here."""

    def __init__(self, root: Node, swept: Mapping[str, _SweptBy], report: Report) -> None:
        self.computed: list[Computed] = []
        self._report = report
        self._constants = root.get(CONSTANTS).entries
        self._swept = swept
        self._axes = swept_values(root)
        self._values: dict[str, Exact] = {}
        self._open: dict[str, Formula] = {}  # constants that depend on swept ones
        self._wrong: set[str] = set()  # that have no value, which is reported at their place
        self._within: list[str] = []  # constants that are being evaluated
        for name in self._constants:
            self._constant(name)

    def tree(self, root: Node, only: Collection[str] | None = None) -> Node:
        """Return the tree with numbers; only: sections to which that is limited."""
        if only is None:
            return _walk(root, (), self._replaced)
        entries = {
            key: _walk(below, (key,), self._replaced) if key in only else below
            for key, below in root.entries.items()
        }
        return replace(root, content=entries)

    def _constant(self, name: str) -> None:
        """Find the value of a constant, unless it is known or depends on what is swept."""
        node = self._constants[name]
        if name in self._values or name in self._open or name in self._wrong or name in self._swept:
            return
        if node.number is not None:
            self._values[name] = exact(node.number)
            return
        if name in self._within:
            circle = " -> ".join(f"${one}" for one in [*self._within, name])
            self._report.add(node.mark, f"{name}: is made of itself, {circle}")
            self._wrong.add(name)
            return
        self._wrong.add(name)  # unless what follows succeeds
        if node.text is None or not is_formula(node.text, self._constants):
            return  # refused by the model
        self._wrong.discard(name)
        self._within.append(name)
        formula = self._read(node, name)
        if formula is None or formula.names & self._wrong:
            self._wrong.add(name)
            self._report.doubt()
        elif formula.names & (self._swept.keys() | self._open.keys()):
            self._open[name] = formula
        elif (number := self._number(formula, node, name)) is not None:
            self._values[name] = exact(number)
        else:
            self._wrong.add(name)
        self._within.pop()

    def _read(self, node: Node, name: str, others: Collection[str] = ()) -> Formula | None:
        """Return the formula of a text whose names are constants, or `others`."""
        try:
            formula = read_formula(node.text or "")
        except FormulaError as error:
            self._report.add(node.mark, f"{name}: {self._without_sign(node.text or '', error)}")
            return None
        for one in sorted(formula.names - set(others)):
            if one not in self._constants:
                known = [f"${each}" for each in [*self._constants, *others]]
                what = "constant or axis" if others or name in ("equals", "ideal") else "constant"
                hint = nearest(f"${one}", known) or f"; write `constants: {{{one}: ...}}`"
                self._report.add(node.mark, f"{name}: there is no {what} ${one}{hint}")
                return None
            self._constant(one)
        return formula

    def _without_sign(self, text: str, error: FormulaError) -> str:
        for name in self._constants:
            if str(error).startswith(f'"{name}" in'):
                return f"{quoted(name)} in {quoted(text)} is a constant, written ${name}"
        return str(error)

    def _number(self, formula: Formula, node: Node, name: str) -> float | None:
        try:
            return formula.value(self._values)
        except FormulaError as error:
            self._report.add(node.mark, f"{name}: {error}")
            return None

    def _replaced(self, path: Path, node: Node) -> Node:
        """Return the number's node of a formula; the node itself where it is text or left open."""
        text = node.text or ""
        if not is_formula(text, self._constants):
            return node
        wanted = _key_of_cells(path)
        name = wanted or str(next(step for step in reversed(path) if isinstance(step, str)))
        formula = self._read(node, name, self._axes if wanted else ())
        if formula is None:
            return replace(node, content=BROKEN)
        if wanted and (axes := formula.names & self._axes.keys()):
            self._check_axes(node, axes, name)
        if formula.names & (self._wrong - self._axes.keys() if wanted else self._wrong):
            self._report.doubt()
            return replace(node, content=BROKEN)
        if wanted and (lost := self._not_named(formula)):
            axis = self._swept[lost].axis
            sentence = f"the values of ${lost} do not name the cells of axis {axis}"
            self._report.add(node.mark, f"{name}: {sentence}; put constants.{lost} first in it")
            return replace(node, content=BROKEN)
        if wanted and formula.names & self._axes.keys():
            return replace(node, content=self._with_constants(formula))
        if open_ := sorted(formula.names & (self._swept.keys() | self._open.keys())):
            if wanted:
                return replace(node, content=self._with_constants(formula))
            if path[0] not in OF_CELLS:
                sentence = f"${open_[0]} is swept, so that it has no one number here"
                self._report.add(node.mark, f"{name}: {sentence}")
                return replace(node, content=BROKEN)
            return node
        number = self._number(formula, node, name)
        if number is None:
            return replace(node, content=BROKEN)
        self.computed.append(Computed(".".join(map(str, path)), text, number, node.mark))
        return replace(node, content=number)

    def _check_axes(self, node: Node, axes: Collection[str], name: str) -> None:
        for axis in sorted(axes):
            if any(value.number is None for value in self._axes[axis]):
                sentence = f"axis ${axis} has values that are no numbers"
                self._report.add(node.mark, f"{name}: {sentence}")
            elif axis in self._constants and (
                axis not in self._swept or self._swept[axis].axis != axis
            ):
                instead = f"let the axis vary constants.{axis}, or rename one"
                sentence = f"${axis} is a constant and an axis of another path; {instead}"
                self._report.add(node.mark, f"{name}: {sentence}")

    def _not_named(self, formula: Formula) -> str | None:
        """Return a swept constant that the coordinates of cells do not tell."""
        for name in sorted(formula.names - self._axes.keys()):
            if name in self._swept and not self._swept[name].named:
                return name
            if name in self._open and (lost := self._not_named(self._open[name])):
                return lost
        return None

    def _with_constants(self, formula: Formula) -> str:
        """Return a formula that takes nothing but axes."""
        texts: dict[str, str] = {}
        for name in formula.names:
            if name in self._axes:
                continue
            if name in self._swept:
                texts[name] = f"${self._swept[name].axis}"
            elif name in self._open:
                texts[name] = f"({self._with_constants(self._open[name])})"
            else:
                texts[name] = _written(self._values[name])
        return formula.with_values(texts)


def _written(value: Exact) -> str:
    """Return a number as a formula has it."""
    if isinstance(value, float):
        text = repr(value)
    elif value.denominator == 1:
        text = str(value)
    else:
        text = repr(float(value)) if exact(float(value)) == value else repr(Ratio(value))
    return f"({text})" if text[0] == "-" or "/" in text else text


def constants_of(root: Node) -> dict[str, tuple[Node, Mark]]:
    """Return each constant's node and the place of its name."""
    section = root.get(CONSTANTS)
    return {name: (node, key_mark(section, name)) for name, node in section.entries.items()}
