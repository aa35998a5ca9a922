"""How many of the cores that this process may use have had nothing to do, as Linux counts it.

A second process gains by a core that nobody uses: where others have all of them, it takes as long
to begin as elsewhere and saves nothing.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from math import inf
from pathlib import Path
from time import perf_counter
from typing import Final

STATISTICS: Final = Path("/proc/stat")
# Of one's own ten milliseconds: that is what the system counts in.
LEAST: Final = 0.1  # [s] over which a number means something
# Of a core, behind its name: user, nice, system, idle, waiting for disks, ..
_NICE, _IDLE, _WAITS = 2, 4, 5


class IdleCores:
    """Looks at the cores now and then."""

    def __init__(
        self, statistics: Path = STATISTICS, clock: Callable[[], float] = perf_counter
    ) -> None:
        """Begin to count."""
        self._statistics, self._clock = statistics, clock
        self._known = inf
        self._before = clock(), self._time()

    def idle(self) -> float:
        """Return how many were idle since this was asked before; infinity where nobody tells.

        Within less than LEAST it is as it was, and at first as if all were idle.
        """
        time, idle = self._before
        now = self._clock()
        if idle is None or now - time < LEAST:
            return self._known
        found = self._time()
        if found is not None:
            self._known = (found - idle) / (now - time)
        self._before = now, found
        return self._known

    def _time(self) -> float | None:
        """Return for how long cores have been idle in all [s]; None where nobody tells."""
        try:
            text, cores = self._statistics.read_text(), os.sched_getaffinity(0)
            return idle_time(text, cores, is_nice=os.nice(0) > 0)
        except (AttributeError, OSError, ValueError):  # another system, or one that hides it
            return None


def idle_time(statistics: str, cores: Collection[int], is_nice: bool) -> float:
    """Return for how long these cores have been idle in all [s]; statistics: of /proc/stat.

    With them counts what nice processes took, unless this is one: they give way. ValueError where
    it is no such text.
    """
    names = {f"cpu{core}" for core in cores}
    columns = (_IDLE, _WAITS) if is_nice else (_NICE, _IDLE, _WAITS)
    rows = [line.split() for line in statistics.splitlines()]
    found = [sum(int(row[k]) for k in columns) for row in rows if row and row[0] in names]
    if not found:
        raise ValueError("none of these cores is in the statistics")
    return sum(found) / os.sysconf("SC_CLK_TCK")


# Of this process, from its first import of this: what is asked soon after has something to go by.
CORES: Final = IdleCores()
