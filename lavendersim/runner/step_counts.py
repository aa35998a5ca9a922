"""What stands beside the time of a step: its contacts and its iterations, as the log has them.

An engine that does not report one of them has no such column; it is None then, which is no zero.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

CONTACTS, ITERATIONS = "contact_count", "sweeps"  # columns of /step


class StepCounts(NamedTuple):
    """Of the steps of several cells together."""

    contacts: float | None = None  # a step, on average; None: not reported
    iterations: float | None = None


def counts_of(cells: Iterable[Any]) -> StepCounts:
    """Return the counts of the steps of cells; what one log does not have, none of them has."""
    logs = []
    for cell in cells:
        logs.append(cell.trace().step[1:])  # its first row is the initial state
        cell.release()
    return StepCounts(*(_mean(logs, name) for name in (CONTACTS, ITERATIONS)))


def _mean(logs: list[Any], name: str) -> float | None:
    if not all(name in (step.dtype.names or ()) for step in logs):
        return None
    values = [step[name] for step in logs if len(step)]
    return float(np.mean(np.concatenate(values))) if values else None


def in_words(counts: StepCounts) -> str:
    """Return the counts of a step as people say them: `12 contacts, 3.4 iterations a step`."""
    reported = [
        f"{value:.3g} {name}"
        for value, name in zip(counts, ("contacts", "iterations"), strict=True)
        if value is not None
    ]
    return f"{', '.join(reported)} a step" if reported else "nothing reported of a step's contacts"
