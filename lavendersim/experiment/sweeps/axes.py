"""The axes of the `sweep` section: coordinates and tree of every cell.

A cell is the tree as written with the swept values' own nodes grafted in, so that whatever is wrong
with a cell is reported at the value that makes it wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from lavendersim.experiment.models.axis import axis_values
from lavendersim.experiment.models.tree import products
from lavendersim.experiment.resolve.first_members import with_first_members
from lavendersim.experiment.resolve.formulas import CONSTANTS, Computed, with_numbers_of_cell
from lavendersim.experiment.resolve.named_shapes import with_named_shapes
from lavendersim.experiment.resolve.presets import with_named_preset, with_preset
from lavendersim.experiment.sweeps.paths import NAMED, find_path
from lavendersim.experiment.text.node import Broken, Node, Path, graft, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import found, quoted
from lavendersim.quantities.scalars import Ratio, exact, label

MOST_CELLS = 100_000


@dataclass(frozen=True)
class SweptAxis:
    """One axis: its name, the nodes that name its cells, and the places that it varies.

    places: each path with the nodes that it takes, one a cell.
    """

    name: str
    values: tuple[Node, ...]
    places: tuple[tuple[Path, tuple[Node, ...]], ...]

    @cached_property
    def coordinates(self) -> tuple[Any, ...]:
        """Its values as cells hold them; made once, for each is that of many cells."""
        return tuple(swept_value(node.data) for node in self.values)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """What labels of cells say of its values: `e=0.8`."""
        return tuple(f"{self.name}={label(value)}" for value in self.coordinates)

    @property
    def paths(self) -> tuple[Path, ...]:
        """The paths that it varies."""
        return tuple(path for path, _ in self.places)

    def overlaps(self, other: SweptAxis) -> bool:
        """Tell whether both vary one place, or one a part of what the other varies."""
        return any(_overlap(a, b) for a in self.paths for b in other.paths)


# Of each product of the sweep, its axes.
Products = tuple[tuple[SweptAxis, ...], ...]


@dataclass(frozen=True, slots=True)
class SweepPoint:
    """One cell of the sweep before it is resolved: of each axis, the index of its value."""

    choices: tuple[tuple[SweptAxis, int], ...]

    @property
    def coordinates(self) -> dict[str, Any]:
        """Axis name -> swept value; ratios are Fractions."""
        return {axis.name: axis.coordinates[k] for axis, k in self.choices}

    @property
    def nodes(self) -> dict[Path, Node]:
        """The node of this cell at each path that is varied."""
        return {path: nodes[k] for axis, k in self.choices for path, nodes in axis.places}

    @property
    def label(self) -> str:
        """The coordinates as text: `e=0.8, timestep=1/480`; empty without a sweep."""
        return ", ".join(axis.labels[k] for axis, k in self.choices)

    def tree(self, root: Node, report: Report | None = None) -> Node:
        """Return the config of this cell; notes formulas without a number, shapes of no name."""
        report = report or Report("")
        root = self._grafted(root)
        if self._sweeps_constants:
            root, _ = with_numbers_of_cell(root, report)
        return with_preset(with_named_shapes(with_first_members(root), report))

    def computed(self, root: Node) -> list[Computed]:
        """Return the numbers of formulas that take a constant that is swept."""
        if not self._sweeps_constants:
            return []
        return with_numbers_of_cell(self._grafted(root), Report(""))[1]

    @property
    def _sweeps_constants(self) -> bool:
        return any(path[0] == CONSTANTS for axis, _ in self.choices for path in axis.paths)

    def _grafted(self, root: Node) -> Node:
        for path, node in self.nodes.items():
            root = graft(opened(root, path), path, node)
        return root


def swept_value(value: Any) -> Any:
    """Return a value as cells hold it: a ratio as its Fraction, lists as tuples."""
    if isinstance(value, Ratio):
        return Fraction(value.fraction)
    if isinstance(value, tuple):
        return tuple(swept_value(item) for item in value)
    return value


def axes_of(root: Node, report: Report) -> Products:
    """Return the axes of each product, without those that are refused here."""
    read: list[tuple[SweptAxis, ...]] = []
    paths: dict[str, tuple[Path, ...]] = {}
    for product in products(root):
        axes: list[SweptAxis] = []
        for name, node in product.entries.items():
            axis = _axis(name, node, root, report)
            if axis is None:
                continue
            if paths.setdefault(name, axis.paths) != axis.paths:
                sentence = f"{name}: varies another path earlier in the file; rename it"
                report.add(key_mark(product, name), sentence)
            elif clash := next((one for one in axes if one.overlaps(axis)), None):
                sentence = f"{name}: varies the same place as axis {quoted(clash.name)}"
                report.add(key_mark(product, name), sentence)
            else:
                axes.append(axis)
        read.append(tuple(axes))
    return tuple(read)


def points(axes: Products) -> Iterator[SweepPoint]:
    """Yield all cells: product after product, the first axis slowest; one without a sweep."""
    for product in axes or ((),):
        # of each value one pair, which all its cells have
        choices = [[(axis, index) for index in range(len(axis.values))] for axis in product]
        for point in itertools.product(*choices):
            yield SweepPoint(point)


def count(axes: Products) -> int:
    """Return the number of cells without making them."""
    return sum(math.prod(len(axis.values) for axis in product) for product in axes or ((),))


def covering_points(axes: Products) -> Iterator[tuple[SweptAxis | None, SweepPoint]]:
    """Yield a few cells in which every value of every axis stands once, for large sweeps.

    With the axis that each is there for; None: the cell of a product without axes.
    """
    for product in axes or ((),):
        if not product:
            yield None, SweepPoint(())
        first = [(axis, 0) for axis in product]
        for place, axis in enumerate(product):
            for index in range(len(axis.values)):
                yield axis, SweepPoint((*first[:place], (axis, index), *first[place + 1 :]))


def check_distinct(axes: Products, report: Report) -> None:
    """Note cells that stand twice in a union of products."""
    seen: set[str] = set()
    for product in axes if len(axes) > 1 else ():
        for point in points((product,)):
            label = point.label
            if label in seen and product:
                mark = product[-1].values[0].mark
                report.add(mark, f"sweep: cell {quoted(label)} stands in an earlier product too")
                break
            seen.add(label)


def _axis(name: str, node: Node, root: Node, report: Report) -> SweptAxis | None:
    own, values = node.get("paths").entries, axis_values(node)
    written = _path_nodes(node)
    if not written or not values:
        return None  # refused by the model
    lists = [tuple(one.items) for one in own.values()] or [values] * len(written)
    if any(len(nodes) != len(values) for nodes in lists):
        return None  # likewise
    places: list[tuple[Path, tuple[Node, ...]]] = []
    for path_node, nodes in zip(written, lists, strict=True):
        path = find_path(path_node, root, report)
        if path is None:
            continue
        if any(_overlap(path, other) for other, _ in places):
            sentence = f"path: {path_node.text} is varied by the same axis already"
            report.add(path_node.mark, sentence)
            continue
        places.append((path, nodes))
        if nodes is not values:
            _check_kinds(name, nodes, report, _nullable(path))
    if len(places) < len(written):
        return None
    nullable = all(_nullable(path) for path, _ in places)
    usable = _usable(name, values, report, nullable)
    if len(usable) < len(values):
        places = [(path, usable) for path, nodes in places if nodes is values]
    return SweptAxis(name, usable, tuple(places)) if usable and places else None


def _path_nodes(axis: Node) -> list[Node]:
    """Return the nodes of an axis's paths; of a mapping, its keys at their places."""
    paths = axis.get("paths")
    nodes = [node for node in (axis.get("path"), *paths.items) if node.text is not None]
    return nodes + [Node(key, key_mark(paths, key)) for key in paths.entries]


def _overlap(one: Path, other: Path) -> bool:
    return one[: len(other)] == other[: len(one)]


def _nullable(path: Path) -> bool:
    return path == ("numerics", "tolerance")


def _check_kinds(name: str, nodes: Sequence[Node], report: Report, nullable: bool) -> bool:
    """Note values of a wrong kind; nullable: null means something, and no value that is missing."""
    sound = True
    for value in nodes:
        if (value.content is None and not nullable) or isinstance(value.content, dict):
            sentence = f"{name}: expected a number, a text, true, false or a list"
            report.add(value.mark, f"{sentence}, found {found(value.data)}")
            sound = False
    return sound


def _usable(name: str, values: Sequence[Node], report: Report, nullable: bool) -> tuple[Node, ...]:
    """Return the values without those that are refused; their labels differ."""
    usable: dict[object, Node] = {}
    labels: set[str] = set()
    for value in values:
        if isinstance(value.content, Broken):
            continue  # a formula that was refused
        if not _check_kinds(name, (value,), report, nullable):
            continue
        shown = label(value.data)
        number = value.number
        key = (type(value.content), shown) if number is None else exact(number)
        if key in usable:
            report.add(value.mark, f"{name}: value {shown} stands twice")
        elif shown in labels:
            sentence = f"{name}: another value reads {shown} too; labels show six digits"
            report.add(value.mark, sentence)
        else:
            usable[key] = value
            labels.add(shown)
    return tuple(usable.values())


def opened(root: Node, path: Path) -> Node:
    """Return the tree with a name that the path enters replaced by what it names.

    `numerics: chapter` becomes {preset: chapter}, `surface: rubber` this body's own copy of rubber,
    `shape: cube` its own copy of cube.
    """
    for length in range(1, len(path)):
        node = root.get(*path[:length])
        if node.text is None:
            continue
        if path[:length] == ("numerics",):
            root = with_named_preset(root)
        elif named := root.get("scene", NAMED.get(str(path[length - 1]), ""), node.text):
            root = graft(root, path[:length], named)
    return root
