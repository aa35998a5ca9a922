"""Of which steps a log has contacts and poses, where it has them not of all (`record`)."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell.record import ALL, CellRecord, Recorded, TimeWindow, in_words, steps_between
from lavendersim.clock import Clock
from lavendersim.quantities.scalars import exact

KEYS: Final = {"/contacts": "contacts", "/tf": "poses"}  # topic -> key of `record`
RECORDED: Final = "recorded"  # metadata record of what is not recorded of all steps: key -> which


def is_recorded(recorded: Recorded, clock: Clock, steps: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which of some steps are recorded; 0 is the initial state.

    every N: 0, N, 2 N, ...; a stretch of time: the steps that end within it.
    """
    if isinstance(recorded, TimeWindow):
        # By the number as written: 0.1 s is a step of 1/10 s, its binary value lies beside it.
        first = clock.steps_until(exact(recorded.begin))
        return (steps >= first) & (steps <= clock.steps_within(exact(recorded.end)))
    every = steps_between(recorded)
    return steps % every == 0 if every else np.ones(len(steps), bool)


def recorded_states(recorded: Recorded, clock: Clock, steps: int) -> int:
    """Return how many states of a run of so many steps are recorded, the initial one with them."""
    if isinstance(recorded, TimeWindow):
        first = clock.steps_until(exact(recorded.begin))
        last = min(clock.steps_within(exact(recorded.end)), steps)
        return max(0, last - first + 1)
    return steps // max(steps_between(recorded), 1) + 1


def described(record: CellRecord) -> dict[str, str]:
    """Return of what is not recorded of every step, of which it is; by the keys of the config."""
    return {
        key: in_words(getattr(record, key)) for key in KEYS.values() if getattr(record, key) != ALL
    }


def partly_recorded(record: dict[str, str]) -> dict[str, str]:
    """Return the topics of which a log has not every step, each with a reason; record: described.

    Whoever needs every step does without them, as without a topic that is not there.
    """
    return {topic: f"record.{key} is {record[key]}" for topic, key in KEYS.items() if key in record}
