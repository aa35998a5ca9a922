"""What was drawn at random for a cell, in words for its log.

The jitter of a grid and perturbed starts are drawn; a resolved cell holds the places that came of
them, not their seeds.
"""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.experiment import Cell, Experiment, Node

NONE = "none, nothing is drawn at random"


class Seeds:
    """The seeds of an experiment, cell by cell."""

    def __init__(self, experiment: Experiment) -> None:
        arrangements = experiment.tree.get("scene", "arrangements").entries
        self._drawn = (
            any(arrangement.get("kind").text == "grid" for arrangement in arrangements.values())
            or bool(experiment.tree.get("scene", "perturbation"))
            or any(path.startswith("scene.perturbation") for path in experiment.swept)
        )

    def of(self, cell: Cell) -> str:
        """Return `ball: 1, rod: 7` for the arrangements that are jittered, or that none is; and of
        perturbed starts.
        """
        drawn = ", ".join(_drawn(cell.tree)) if self._drawn else ""
        return drawn or NONE


def _drawn(tree: Node) -> Iterator[str]:
    for name, arrangement in tree.get("scene", "arrangements").entries.items():
        if arrangement.get("jitter").number:
            yield f"{name}: {int(arrangement.get('seed').number or 0)}"
    if seed := int(tree.get("scene", "perturbation", "seed").number or 0):
        yield f"perturbation: {seed}"
