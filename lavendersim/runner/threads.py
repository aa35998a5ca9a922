"""How many threads share the sweeps of a step: the environment tells a run and its processes."""

from __future__ import annotations

import os
from typing import Final

from lavendersim.engine.team import MOST
from lavendersim.errors import UsageError

VARIABLE: Final = "LAVENDER_THREADS"  # set by `lavender run --threads`


def threads_asked() -> int:
    """Return how many threads the environment asks for, one by default.

    Raises UsageError where it is no whole number from 1 on.
    """
    asked = os.environ.get(VARIABLE, "1")
    if not asked.isdecimal() or not int(asked):
        raise UsageError(f"{VARIABLE}: expected a whole number from 1 to {MOST}, found {asked!r}")
    return min(int(asked), MOST)
