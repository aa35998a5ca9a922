"""Values from the command line, in the place of what a config says.

    set numerics.timestep=1/480          one value, at a path that a sweep may vary
    sweep e=scene.bodies.ball.surface.restitution:[0.2, 0.5]      an axis, new or instead of one
    sweep e=scene.bodies.ball.surface.restitution:0.2,0.5         the same, for who types it

Values are YAML. What is wrong with one is reported at its place in the option.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from lavendersim.experiment.sweeps.axes import SweptAxis, opened
from lavendersim.experiment.sweeps.paths import find_path
from lavendersim.experiment.text.node import Mark, Node, graft
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report

SET: Final = "set "
SWEEP: Final = "sweep "
FORMS: Final = {SET: "--set PATH=VALUE", SWEEP: "--sweep NAME=PATH:[VALUES]"}


def with_overrides(root: Node, overrides: Sequence[str], report: Report) -> Node:
    """Return the tree with the values of the overrides; notes what is wrong with them."""
    for override in overrides:
        option = f"--{override}"
        kind = SWEEP if override.startswith(SWEEP) else SET
        name, found, value = override.removeprefix(kind).partition("=")
        path, values = name, value
        if kind == SWEEP:
            path, separated, values = value.partition(":")
            found = found and separated
        if not found or not values.strip():
            report.add(Mark(1, 1, option), f"expected {FORMS[kind]}")
            continue
        begin = 2 + len(override) - len(values)  # behind the dashes
        if kind == SWEEP and not values.lstrip().startswith("["):
            values, begin = f"[{values}]", begin - 1
        node = _parsed(values, Mark(1, begin, option), report)
        if node is None:
            continue
        at = Node(path.strip(), Mark(1, 2 + override.index(path, len(kind)) + 1, option))
        if kind == SWEEP:
            axis = Node({"path": at, "values": node}, at.mark, {"path": at.mark, "values": at.mark})
            root = _with_axis(root, name.strip(), axis, report)
        elif (place := find_path(at, root, report)) is not None:
            root = graft(opened(root, place), place, node)
    return root


def check_untouched(root: Node, axes: Sequence[Sequence[SweptAxis]], report: Report) -> None:
    """Note values that were set where an axis varies them."""
    varied = {path: axis.name for product in axes for axis in product for path in axis.paths}
    for path, name in varied.items():
        mark = root.get(*path).mark
        if mark.file.startswith("--"):
            dotted = ".".join(map(str, path))
            instead = f"--sweep {name}={dotted}:[...]"
            report.add(mark, f"{dotted} is varied by axis {name}; expected {instead}")


def _with_axis(root: Node, name: str, axis: Node, report: Report) -> Node:
    products = root.get("sweep").items
    if not products:
        return graft(root, ("sweep", name), axis)
    if any(name in product.entries for product in products):
        sentence = (
            f"{name} is an axis of a list of products in this file, each with its own values; "
            "expected a name of none of them"
        )
        report.add(axis.mark, sentence)
        return root
    for place in range(len(products)):  # what all of them list, times the new axis
        root = graft(root, ("sweep", place, name), axis)
    return root


def _parsed(text: str, begin: Mark, report: Report) -> Node | None:
    """Return a value, its places those in the option; None where it is none."""
    own = Report("")
    node = parse(text.encode("utf-8", "surrogatepass"), own)
    for defect in own.defects:
        report.add(begin._replace(column=begin.column + defect.column), defect.message)
    return None if node is None or own.defects else _placed(node, begin)


def _placed(node: Node, begin: Mark) -> Node:
    content = node.content
    if isinstance(content, tuple):
        content = tuple(_placed(item, begin) for item in content)
    elif isinstance(content, dict):
        content = {key: _placed(value, begin) for key, value in content.items()}
    keys = {key: _moved(mark, begin) for key, mark in node.keys.items()}
    return Node(content, _moved(node.mark, begin), keys, node.incomplete)


def _moved(mark: Mark, begin: Mark) -> Mark:
    return begin._replace(column=begin.column + mark.column)
