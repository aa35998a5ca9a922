"""The tree of one cell in; a mistake of `study` that its numerics have no place for is noted."""

from __future__ import annotations

from typing import Final

from lavendersim.cell.choices import CAPTURE_IN_SWEEPS
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.report import Report

# What the numerics must state for a mistake to be one: key, value, and why.
_PLACES: Final = {
    CAPTURE_IN_SWEEPS: (
        ("solver", "projected_gauss_seidel", "is a mistake in the loop of projected_gauss_seidel"),
        ("impacts", "captured", "is a mistake of captured restitution"),
    )
}


def check_study(root: Node, report: Report) -> None:
    """Note a mistake that cannot be made with the numerics of this cell."""
    mistake = root.get("study", "mistake")
    if mistake is None or mistake.text not in _PLACES:
        return
    for key, expected, why in _PLACES[mistake.text]:
        stated = root.get("numerics", key)
        found = stated.text if stated is not None else None
        if found in (None, expected):  # no text is refused elsewhere
            continue
        marks = [node.mark for node in (mistake, stated) if node is not None]
        sentence = f"mistake: {mistake.text} {why}; expected {key}: {expected}, found {found}"
        report.add(max(marks), sentence)  # swept values stand below what they replace
