"""Keys of a cell that its engine cannot do, each refused where the file has it."""

from __future__ import annotations

from lavendersim.cell.config import CellConfig
from lavendersim.experiment.checks.messages import locate
from lavendersim.experiment.text.node import Mark, Node, Path, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.peers.limits import limits_of


def refuse_limits(config: CellConfig, tree: Node, report: Report) -> None:
    """Note what of a resolved cell its engine cannot do; tree: that the cell was made of."""
    places: dict[Mark, str] = {}  # of several bodies of one surface the first is named
    for path, sentence in limits_of(config):
        places.setdefault(_place(tree, path), sentence)
    for mark, sentence in places.items():
        report.add(mark, sentence)


def _place(tree: Node, path: Path) -> Mark:
    """Return where a key stands: that of a body in its surface of a name, of a body that was
    arranged in the first surface that has it, or else at the nearest that is written.
    """
    key = str(path[-1])
    surfaces = tree.get("scene", "surfaces")
    if len(path) > 1 and path[-2] == "surface":
        holder = tree.get(*path[:-1])
        named = surfaces.get(holder.text) if holder.text is not None else holder
        for one in (
            named,
            *surfaces.entries.values(),
            *tree.get("scene", "surface_pairs").entries.values(),
        ):
            if key in one.entries:
                return key_mark(one, key)
    parent = tree.get(*path[:-1])
    if key in parent.entries:
        return key_mark(parent, key)
    return locate(tree, path)[1].mark
