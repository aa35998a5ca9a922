"""What was drawn at random for a cell, in words for its log.

Only the jitter of a grid is drawn; a resolved cell holds the places that came of it, not its seed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from lavendersim.experiment import Experiment

NONE = "none, nothing is drawn at random"


class Seeds:
    """The seeds of an experiment, cell by cell."""

    def __init__(self, experiment: Experiment) -> None:
        # Of the text: `experiment.config` holds the first value of every axis, which is not that of
        # cells whose product leaves the axis alone.
        self._arrangements = experiment.tree.get("scene", "arrangements").entries
        self._paths = experiment.swept

    def of(self, coordinates: Mapping[str, Any]) -> str:
        """Return `ball: 1, rod: 7` for the arrangements that are jittered, or that none is."""
        values = {
            self._paths[axis]: value for axis, value in coordinates.items() if axis in self._paths
        }
        return ", ".join(self._drawn(values)) or NONE

    def _drawn(self, swept: Mapping[str, Any]) -> Iterator[str]:
        for name, arrangement in self._arrangements.items():
            jitter, seed = (
                swept.get(f"scene.arrangements.{name}.{key}", arrangement.get(key).number or 0)
                for key in ("jitter", "seed")
            )
            if jitter:
                yield f"{name}: {int(seed)}"
