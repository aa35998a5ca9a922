"""Where the bodies of a log are after some steps, as its poses come in parts.

Asked in ascending order: no more of the parts is kept than the steps that are asked for.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Steps = NDArray[np.int64]
Floats = NDArray[np.float64]


class Positions:
    """Positions of all bodies after steps that are asked for; no part is read before."""

    def __init__(self, parts: Iterator[tuple[Steps, Floats]]) -> None:
        """parts: steps (n,), ascending, and poses (n, bodies, 7)."""
        self._parts = parts
        self._kept: list[tuple[Steps, Floats]] = []

    def __call__(self, steps: Steps) -> Floats:
        """Return positions (n, bodies, 3) [m]. ValueError where the poses of a step are not there.

        steps: ascending, at least one, and none before those of the last call.
        """
        while not (self._kept and self._kept[-1][0][-1] >= steps[-1]):
            part = next(self._parts, None)
            if part is None:
                break
            self._kept.append(part)
        self._kept = [part for part in self._kept if part[0][-1] >= steps[0]]
        if not self._kept:
            raise _missing(steps[0])
        known = np.concatenate([own for own, _ in self._kept])
        rows = np.searchsorted(known, steps)
        missing = np.flatnonzero(known[np.minimum(rows, len(known) - 1)] != steps)
        if len(missing):
            raise _missing(steps[missing[0]])
        begin = 0
        found = []
        for _, poses in self._kept:
            mine = rows[(rows >= begin) & (rows < begin + len(poses))] - begin
            found.append(poses[mine, :, :3])
            begin += len(poses)
        return np.concatenate(found)


def _missing(step: int) -> ValueError:
    return ValueError(f"no poses of step {step}, by which contacts are expected")
