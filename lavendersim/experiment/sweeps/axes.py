"""The axes of the `sweep` section: coordinates and tree of every cell.

A cell is the tree as written with the swept values' own nodes grafted in, so that whatever is wrong
with a cell is reported at the value that makes it wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from lavendersim.experiment.models.tree import products
from lavendersim.experiment.resolve.presets import with_named_preset, with_preset
from lavendersim.experiment.sweeps.paths import find_path
from lavendersim.experiment.text.node import Node, Path, graft, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.found import found, quoted
from lavendersim.quantities.scalars import Ratio, exact, label

MOST_CELLS = 100_000


@dataclass(frozen=True)
class SweptAxis:
    """One swept value: its name, where it stands in the config, and the nodes of its values."""

    name: str
    path: Path
    values: tuple[Node, ...]

    def overlaps(self, path: Path) -> bool:
        """Tell whether it varies what stands at the path, or a part of it, or what has it."""
        return self.path[: len(path)] == path[: len(self.path)]


# Of each product of the sweep, its axes.
Products = tuple[tuple[SweptAxis, ...], ...]


@dataclass(frozen=True)
class SweepPoint:
    """One cell of the sweep before it is resolved: the nodes to graft in, axis by axis."""

    choices: tuple[tuple[SweptAxis, Node], ...]

    @property
    def coordinates(self) -> dict[str, Any]:
        """Axis name -> swept value; ratios are Fractions."""
        return {axis.name: swept_value(node.data) for axis, node in self.choices}

    @property
    def label(self) -> str:
        """The coordinates as text: `e=0.8, timestep=1/480`; empty without a sweep."""
        return ", ".join(f"{name}={label(value)}" for name, value in self.coordinates.items())

    def tree(self, root: Node) -> Node:
        """Return the config of this cell."""
        for axis, node in self.choices:
            root = graft(opened(root, axis.path), axis.path, node)
        return with_preset(root)


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
    paths: dict[str, Path] = {}
    for product in products(root):
        axes: list[SweptAxis] = []
        for name, node in product.entries.items():
            axis = _axis(name, node, root, report)
            if axis is None:
                continue
            if paths.setdefault(name, axis.path) != axis.path:
                sentence = f"{name}: varies another path earlier in the file; rename it"
                report.add(key_mark(product, name), sentence)
            elif clash := next((one for one in axes if one.overlaps(axis.path)), None):
                sentence = f"{name}: varies the same place as axis {quoted(clash.name)}"
                report.add(key_mark(product, name), sentence)
            else:
                axes.append(axis)
        read.append(tuple(axes))
    return tuple(read)


def points(axes: Products) -> Iterator[SweepPoint]:
    """Yield all cells: product after product, the first axis slowest; one without a sweep."""
    for product in axes or ((),):
        for nodes in itertools.product(*(axis.values for axis in product)):
            yield SweepPoint(tuple(zip(product, nodes, strict=True)))


def count(axes: Products) -> int:
    """Return the number of cells without making them."""
    return sum(math.prod(len(axis.values) for axis in product) for product in axes or ((),))


def covering_points(axes: Products) -> Iterator[SweepPoint]:
    """Yield a few cells in which every value of every axis stands once, for large sweeps."""
    for product in axes or ((),):
        if not product:
            yield SweepPoint(())
        first = [(axis, axis.values[0]) for axis in product]
        for index, axis in enumerate(product):
            for node in axis.values:
                yield SweepPoint((*first[:index], (axis, node), *first[index + 1 :]))


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
    path_node, values = node.get("path"), node.get("values")
    if path_node.text is None or not values.items:
        return None  # refused by the model
    path = find_path(path_node, root, report)
    usable = _usable(name, values, report, nullable=path == ("numerics", "tolerance"))
    return SweptAxis(name, path, usable) if path is not None and usable else None


def _usable(name: str, values: Node, report: Report, nullable: bool) -> tuple[Node, ...]:
    """nullable: null means something, and no value that is missing."""
    usable: dict[object, Node] = {}
    labels: set[str] = set()
    for value in values.items:
        if (value.content is None and not nullable) or isinstance(value.content, dict):
            sentence = f"{name}: expected a number, a text, true, false or a list"
            report.add(value.mark, f"{sentence}, found {found(value.data)}")
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

    `numerics: chapter` becomes {preset: chapter}, `surface: rubber` this body's own copy of rubber.
    """
    for length in range(1, len(path)):
        node = root.get(*path[:length])
        if node.text is None:
            continue
        if path[:length] == ("numerics",):
            root = with_named_preset(root)
        elif named := root.get("scene", "surfaces", node.text):
            root = graft(root, path[:length], named)
    return root
