"""What the process of an engine sends, message by message; and where a sum of rows is one array."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Task(NamedTuple):
    """What a process is started for."""

    config: str  # the cell, as JSON
    engine: str  # variant
    settings: dict[str, Any]


class Built(NamedTuple):
    """The scene stands in the engine as described."""

    version: str
    build_ns: int


class States(NamedTuple):
    """The states of some steps, of movable bodies; the first message has the initial state."""

    first: int  # step
    pose: NDArray[np.float64]  # (steps, movable, 7)
    velocity: NDArray[np.float64]  # (steps, movable, 6)
    contacts: NDArray[np.float64]  # (rows, 3 + reported): step, body A, body B, what is reported
    step_ns: int  # spent in the engine's steps alone
    iterations: NDArray[np.int64] | None = None  # of each step, where the engine counts them


class Ended(NamedTuple):
    """The process is done; why: empty where it made all its steps."""

    why: str
