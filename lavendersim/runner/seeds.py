"""What was drawn at random for a cell, in words for its log.

Only the jitter of a grid is drawn; a resolved cell holds the places that came of it, not its seed.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.experiment import Cell, Experiment, Node

NONE = "none, nothing is drawn at random"


class Seeds:
    """The seeds of an experiment, cell by cell."""

    def __init__(self, experiment: Experiment) -> None:
        arrangements = experiment.tree.get("scene", "arrangements").entries
        self._jittered = any(
            arrangement.get("kind").text == "grid" for arrangement in arrangements.values()
        )

    def of(self, cell: Cell) -> str:
        """Return `ball: 1, rod: 7` for the arrangements that are jittered, or that none is."""
        drawn = ", ".join(_drawn(cell.tree)) if self._jittered else ""
        return drawn or NONE


def _drawn(tree: Node) -> Iterator[str]:
    for name, arrangement in tree.get("scene", "arrangements").entries.items():
        if arrangement.get("jitter").number:
            yield f"{name}: {int(arrangement.get('seed').number or 0)}"
