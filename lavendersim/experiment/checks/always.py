"""The tree of one cell in; what its `always` section cannot judge in this scene is noted.

A balance needs both of its sides in the log. The work of a surface that moves by itself, and the
momentum that a medium or falling asleep takes, are in no log: there the check says so and asks for
`none`, instead of judging half a balance.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.experiment.checks.population import described
from lavendersim.experiment.checks.scene import is_kinematic
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.report import Report
from lavendersim.measures.specs.always import NONE
from lavendersim.quantities.found import quoted


def check_always(root: Node, report: Report) -> None:
    """Note balances that the log of this cell cannot give."""
    always = root.get("always")
    if always is None or not isinstance(always.content, dict):
        return
    for check, reasons in (("energy", _unknown_work(root)), ("momentum", _unknown_impulse(root))):
        stated = always.get(check)
        if stated is not None and stated.text == NONE:
            continue
        mark = stated.mark if stated is not None else key_mark(root, "always")
        for reason in reasons:
            report.add(mark, f"{check}: {reason}; state {check}: none")
            break


def _unknown_work(root: Node) -> Iterator[str]:
    for path, body in described(root):
        name = quoted(path[2])
        if is_kinematic(body):
            yield f"{name} moves by itself, and its work is not in the log"
        if _any(body.get("surface_velocity")):
            yield f"the surface of {name} moves by itself, and its work is not in the log"


def _unknown_impulse(root: Node) -> Iterator[str]:
    for path, body in described(root):
        drag = body.get("drag")
        if drag is not None and any(_any(value) for value in drag.entries.values()):
            yield f"what the drag of {quoted(path[2])} takes is not in the log"
    sleeping = root.get("numerics", "sleeping")
    if sleeping is not None and sleeping.content is True:
        yield "what falling asleep takes is not in the log"


def _any(node: Node | None) -> bool:
    """Tell whether a number, or one of a list of them, is not zero."""
    if node is None:
        return False
    return any(bool(item.number) for item in node.items or (node,))
