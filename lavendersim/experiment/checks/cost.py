"""Checks of a config's `cost` section against its sweep, events and length. Works on the tree."""

from __future__ import annotations

from typing import Final

from lavendersim.experiment.checks.references import products
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.report import Report

# Names of the grid's own axes.
GRID_NAMES: Final = frozenset(
    {"numerics", "preset", "timestep", "solver", "sweeps", "tolerance", "warm_start"}
)


def check_cost(root: Node, length: float | None, report: Report) -> None:
    """Note what keeps a grid of settings from being run and timed in one go."""
    if root.get("cost") is None:
        return
    mark = key_mark(root, "cost")
    for path, said in ((("events",), "events"), (("scene", "forces"), "scene.forces")):
        other = root.get(*path)
        if other is not None and other.items:
            report.add(mark, f"cost: expected a scene without events and forces, found {said}")
    _check_axes(root, report)
    begin = root.get("cost", "from")
    start = begin.number if begin is not None else None
    if begin is not None and start is not None and length is not None and start >= length > 0:
        sentence = f"from: expected a time before the end (duration {length:g} s), found {start:g}"
        report.add(begin.mark, sentence)


def _check_axes(root: Node, report: Report) -> None:
    """Refuse an axis that the grid of settings has itself."""
    for product in products(root):
        for name, axis in product.entries.items():
            path = axis.get("path")
            if path is not None and (path.text or "").split(".")[0] == "numerics":
                sentence = "path: numerics are varied by the section cost; leave them to that"
                report.add(path.mark, sentence)
            elif name in GRID_NAMES:
                sentence = f"{name}: the section cost has an axis of this name; rename this one"
                report.add(key_mark(product, name), sentence)
