"""The section `always` in a file: its balances are judged where the log has both of their sides.

The work of a surface that moves by itself, and the momentum that a medium or falling asleep takes,
are in no log.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

from lavendersim.experiment.models.tree import described
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.place import Place
from lavendersim.measures.specs.always import NONE, Always
from lavendersim.quantities.found import quoted


class AlwaysSection(Always):
    """What every step of every cell must keep; `always: {}` takes every default."""

    @classmethod
    def rules(cls, at: Place) -> None:
        """A balance has both of its sides in the log; half a balance cannot be judged."""
        for check, reasons in (
            ("energy", _unknown_work(at.root)),
            ("momentum", _unknown_impulse(at.root)),
        ):
            bound = at.get(check)
            if bound is None or bound.text != NONE:
                mark = bound.mark if bound is not None else key_mark(at.root, "always")
                for reason in itertools.islice(reasons, 1):
                    at.refuse(mark, f"{check}: {reason}; state {check}: none")


def _unknown_work(root: Node) -> Iterator[str]:
    for name, body in described(root):
        if body.is_true("kinematic"):
            yield f"{quoted(name)} moves by itself, and its work is not in the log"
        if _any(body.items_at("surface_velocity")):
            yield f"the surface of {quoted(name)} moves by itself, and its work is not in the log"


def _unknown_impulse(root: Node) -> Iterator[str]:
    for name, body in described(root):
        if _any(body.entries_at("drag").values()):
            yield f"what the drag of {quoted(name)} takes is not in the log"
    if root.is_true("numerics", "sleeping"):
        yield "what falling asleep takes is not in the log"


def _any(nodes: Iterable[Node]) -> bool:
    """Tell whether one of the numbers is not zero."""
    return any(bool(node.number) for node in nodes)
