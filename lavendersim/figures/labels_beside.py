"""Labels beside the right edge of a panel, each at the end of its line, none upon another.

---o        places where lines end are moved apart until labels have room: the least squares
   |- one   of these moves, by pooling adjacent violators (Ayer et al. 1955)
---o- two
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from lavendersim.figures.style import DARK

SIZE: Final = 9.5  # [pt] of the letters
LINE: Final = 1.3 * SIZE  # [pt] from label to label
LEADER: Final = (1.005, 1.045, 1.055)  # [share of the axis] begin and end of a leader, the text


class LineEnd(NamedTuple):
    """Where a line ends at the right edge, and what it is."""

    label: str
    value: float  # on the y axis
    look: dict[str, Any]  # colour and kind of its leader


def draw_labels_beside(axes: Any, ends: Sequence[LineEnd], height: float) -> None:
    """Write what lines are beside a panel whose y limits are set; height: of the axis [pt]."""
    if not ends:
        return
    to_axes = axes.transData + axes.transAxes.inverted()
    x = axes.get_xlim()[1]
    sought = [float(to_axes.transform((x, end.value))[1]) for end in ends]
    begin, end_of_leader, text = LEADER
    for end, at, place in zip(ends, sought, apart(sought, LINE / height), strict=True):
        leader = {"transform": axes.transAxes, "clip_on": False, "linewidth": 1.1, **end.look}
        axes.plot([begin, end_of_leader], [at, place], **leader)
        axes.text(
            text,
            place,
            end.label,
            transform=axes.transAxes,
            va="center",
            fontsize=SIZE,
            color=DARK,
        )


def apart(sought: Sequence[float], gap: float) -> list[float]:
    """Return places at least `gap` apart, in the order of the sought ones and nearest to them.

    Between 0 and 1 where there is room for all.
    """
    order = np.argsort(sought, kind="stable")
    pools: list[list[float]] = []  # sum and count of sought places, less the gaps below them
    for place in np.asarray(sought, float)[order] - gap * np.arange(len(order)):
        pools.append([float(place), 1.0])
        while len(pools) > 1 and pools[-2][0] * pools[-1][1] > pools[-1][0] * pools[-2][1]:
            total, count = pools.pop()
            pools[-1][0] += total
            pools[-1][1] += count
    level = [total / count for total, count in pools for _ in range(int(count))]
    highest = 1.0 - gap * (len(order) - 1)
    placed = np.clip(level, 0.0, max(highest, 0.0)) + gap * np.arange(len(order))
    places = np.empty(len(order))
    places[order] = placed
    return [float(place) for place in places]
