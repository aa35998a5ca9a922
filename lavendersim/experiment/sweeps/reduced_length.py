"""The reduced length of a slow experiment, which is run where time is short.

slow: true
reduced: {duration: 5.0}
"""

from __future__ import annotations

from lavendersim.experiment.models.axis import axis_paths
from lavendersim.experiment.models.tree import products
from lavendersim.experiment.text.node import Node, graft, key_mark
from lavendersim.experiment.text.report import Report


def check_reduced_length(root: Node, report: Report) -> None:
    """Note a slow experiment without a shorter length, and a shorter length of one not slow."""
    reduced = root.get("reduced")
    is_slow = root.get("slow").is_true
    if is_slow != bool(reduced):
        given, lacks = ("slow", "reduced: {duration: ...}") if is_slow else ("reduced", "")
        sentence = f"{given}: expected {lacks or 'slow: true'} beside it"
        report.add(key_mark(root, given), sentence)
    shorter, whole = reduced.get("duration"), root.get("duration").number
    if shorter.number is None:
        return
    if whole is not None and shorter.number >= whole:
        sentence = f"duration: expected less than the {whole:g} s in full, found {shorter.number:g}"
        report.add(shorter.mark, sentence)
    for product in products(root):
        for axis, node in product.entries.items():
            if "duration" in axis_paths(node):
                mark = (node.get("path") or node.get("paths")).mark
                report.add(mark, f"{axis}: a reduced length and a swept one; keep one")


def at_reduced_length(root: Node) -> tuple[Node, bool]:
    """Return the tree to run where time is short, and whether that is less than all of it."""
    shorter = root.get("reduced", "duration")
    if not root.get("slow").is_true or not shorter:
        return root, False
    return graft(root, ("duration",), shorter), True
