"""The section `always` in a file: a check is made where the log has what it is taken from.

The work of a surface that moves by itself, and the momentum that a medium or falling asleep takes,
are in no log.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Final

from lavendersim.engine.effects import EFFECTS
from lavendersim.experiment.models.recorded import not_recorded
from lavendersim.experiment.models.tree import described
from lavendersim.experiment.text.node import Node, key_mark
from lavendersim.experiment.text.place import Place
from lavendersim.measures.specs.always import CHECKS, FINITE, NONE, READS, Always
from lavendersim.quantities.found import quoted
from lavendersim.quantities.readings import POSES, SUMS

DEFAULTS: Final = {check: Always.model_fields[check].default for check in CHECKS if check != FINITE}


class AlwaysSection(Always):
    """What every step of every cell must keep; `always: {}` takes every default."""

    @classmethod
    def rules(cls, at: Place) -> None:
        """What a check is taken from is in the log; half a balance cannot be judged."""
        for check, default in DEFAULTS.items():
            bound = at.get(check)
            if (bound.text if bound else default) == NONE:
                continue
            mark = bound.mark if bound else key_mark(at.root, "always")
            reason = next(_unlogged(at.root, check), None) or _unrecorded(at.root, check)
            if reason is not None:
                at.refuse(mark, f"{check}: {reason}; specify {check}: none")


def _unrecorded(root: Node, check: str) -> str | None:
    """Return why the log has not of every step what a check takes; None where it has."""
    taken = READS.get(check, SUMS)
    acts = root.get("events").items or root.get("scene", "forces").items
    if check == "energy" and acts:  # what they do is counted by where the bodies are
        taken |= POSES
    reason = not_recorded(root, taken)
    return None if reason is None else f"it {reason}"


def _unlogged(root: Node, check: str) -> Iterator[str]:
    """Yield what effects that a body has a key of leave out of the log, and falling asleep."""
    leaving_out = [
        (effect, unlogged)
        for effect in EFFECTS
        if (unlogged := effect.balance.unlogged) is not None and unlogged.check == check
    ]
    changed = [(event.get("body").text or "", event) for event in root.get("events").items]
    given = [*described(root), *changed]
    for (name, body), (effect, unlogged) in itertools.product(given, leaving_out):
        if any(_is_given(body, key.name) for key in effect.body_keys):
            yield f"{unlogged.what.format(body=quoted(name))} is not in the log"
    if check == "momentum" and root.get("numerics", "sleeping").is_true:
        yield "what falling asleep takes is not in the log"


def _is_given(body: Node, key: str) -> bool:
    """Tell whether a key is true, or one of its numbers is not zero."""
    numbers = (*body.get(key).items, *body.get(key).entries.values())
    return body.get(key).is_true or any(bool(node.number) for node in numbers)
