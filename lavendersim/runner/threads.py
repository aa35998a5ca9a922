"""How many threads share the sweeps of a step: the environment tells a run and its processes."""

from __future__ import annotations

import os
from typing import Final

from lavendersim.engine.team import MOST
from lavendersim.errors import UsageError

VARIABLE: Final = "LAVENDER_THREADS"  # set by `lavender run --threads`


def threads_asked() -> int:
    """Return how many threads the environment asks for, one by default.

    Raises UsageError where it is none that a team may have.
    """
    asked = os.environ.get(VARIABLE) or "1"
    if asked not in map(str, range(1, MOST + 1)):
        raise UsageError(f"{VARIABLE}: expected a whole number from 1 to {MOST}, found {asked!r}")
    return int(asked)
