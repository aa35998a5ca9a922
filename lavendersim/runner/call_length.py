"""How many steps one call of the engine makes: as many as the last one made in a quarter second.

Between calls a run hands its rows to the log, shows how far it is and can be interrupted, so a call
is to take a fraction of a second, whatever a step costs. No byte of a log depends on it.
"""

from __future__ import annotations

from typing import Final

CALL: Final = 0.25  # [s] that a call is to take
# Steps of a call: enough to amortise it, and the passes over its rows, each of which gives the
# interpreter's lock to the threads of the log and waits for it.
MOST: Final = 8192
GROWTH: Final = 8  # from call to call, at most
POSES: Final = 2 * 1024 * 1024  # [byte] of poses that an engine holds


class CallLength:
    """The steps of the next call, from what the last one took."""

    def __init__(self, bodies: int) -> None:
        """bodies: steps of many take longer, and nothing else is known before the first."""
        self.steps = max(MOST // max(bodies, 1), GROWTH)

    def after(self, made: int, seconds: float) -> None:
        """Count a call in."""
        if made > 0:
            due = int(made * CALL / seconds) if seconds > 0.0 else MOST
            self.steps = min(max(due, 1), made * GROWTH, MOST)


def block_steps(steps: int, bodies: int) -> int:
    """Return for how many steps an engine has room: of a run of so many, and its initial state."""
    return min(steps + 1, max(POSES // (56 * max(bodies, 1)), 64), MOST)
