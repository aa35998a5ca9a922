"""What is not recorded of every step cannot be measured, drawn or checked in every step.

record: {contacts: every 4}
measure: {force: {kind: peak_force, body: ball}}   # refused: it takes the contacts of every step
"""

from __future__ import annotations

from collections.abc import Mapping

from lavendersim.cell.record import ALL
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.place import Place
from lavendersim.figures.specs.catalogue import KINDS as PANELS
from lavendersim.measures.specs.catalogue import KINDS as MEASURES
from lavendersim.quantities.readings import EVERYTHING, VELOCITIES, Reader, Readings


def not_recorded(root: Node, taken: Readings) -> str | None:
    """Return why a log has not of every step what is taken of it; None where it has."""
    for key in sorted(taken & EVERYTHING):
        recorded = root.get("record", key)
        if not recorded or recorded.text == ALL:
            continue
        begin, end = recorded.get("from").number, recorded.get("to").number
        within = f"from {begin:g} to {end:g} s" if begin is not None and end is not None else ""
        if words := recorded.text or within:
            return f"takes the {key} of every step, and record.{key} is {words}"
    return None


def recording_rules(at: Place) -> None:
    """Refuse measures and panels that take what is not recorded of every step."""
    for measure in at.get("measure").entries.values():
        _refuse(at, measure, MEASURES)
    for panel in at.get("figure", "panels").items:
        _refuse(at, panel, PANELS)


def _refuse(at: Place, node: Node, kinds: Mapping[str, type[Reader]]) -> None:
    kind = node.get("kind")
    if kind.text is None or kind.text not in kinds:
        return
    given = {key: value.text for key, value in node.entries.items()}
    taken = kinds[kind.text].reads(given)
    if taken >= VELOCITIES and not at.root.get("record", "velocities").is_true:
        sentence = f"kind: {kind.text} takes velocities, and record.velocities is false"
        at.refuse(kind.mark, f"{sentence}; expected true")
    reason = not_recorded(at.root, taken)
    if reason is not None:
        at.refuse(kind.mark, f"kind: {kind.text} {reason}; expected all")
