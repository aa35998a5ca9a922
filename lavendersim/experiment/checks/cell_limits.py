"""Keys that an engine cannot do, or an effect not be with, each refused where the file has it."""

from __future__ import annotations

from lavendersim.cell.config import CellConfig
from lavendersim.engine.effects import EFFECTS
from lavendersim.experiment.checks.image_limits import limits_of_images
from lavendersim.experiment.checks.messages import locate
from lavendersim.experiment.text.node import Mark, Node, Path, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.peers.limits import limits_of

_EXCLUDING = tuple(effect.excludes for effect in EFFECTS if effect.excludes is not None)


def refuse_limits(config: CellConfig, tree: Node, report: Report) -> None:
    """Note what of a resolved cell cannot be simulated; tree: that the cell was made of."""
    places: dict[Mark, str] = {}  # of several bodies of one surface the first is named
    for path, sentence in limits_of(config):
        places.setdefault(_place(tree, path), sentence)
    for excludes in (*_EXCLUDING, limits_of_images):
        for path, sentence in excludes(config):
            places.setdefault(_place(tree, path), f"{path[-1]}: {sentence}")
    for mark, sentence in places.items():
        report.add(mark, sentence)


def _place(tree: Node, path: Path) -> Mark:
    """Return where a key stands: that of a body in its surface of a name, of a body that was
    arranged in the first surface that has it, or else at the nearest that is written.
    """
    key, parent = str(path[-1]), tree.get(*path[:-1])
    if path[0] == "events" and len(path) > 1:
        parent = _planned(tree)[int(path[1])]
    surfaces = tree.get("scene", "surfaces")
    if len(path) > 1 and path[-2] == "surface":
        named = surfaces.get(parent.text) if parent.text is not None else parent
        for one in (
            named,
            *surfaces.entries.values(),
            *tree.get("scene", "surface_pairs").entries.values(),
        ):
            if key in one.entries:
                return key_mark(one, key)
    return key_mark(parent, key) if key in parent.entries else locate(tree, path)[1].mark


def _planned(tree: Node) -> list[Node]:
    """Return the events in the order of a cell, which has those with a trigger last."""
    return sorted(tree.get("events").items, key=lambda one: one.get("when").content is not None)
