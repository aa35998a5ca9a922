"""Rounds of interleaved samples: as many as asked for, fewer where more would change nothing.

A signal ends them early; rounds that were whole by then are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final, NamedTuple

from lavendersim.experiment.models.cost import FEWEST_REPEATS

SETTLED: Final = 0.01  # widest interval around a median, as a share of it, that needs no more

Report = Callable[[str, int, int], None]


class Taken(NamedTuple):
    """How many rounds are whole, and what ended them before their time, if anything did."""

    rounds: int
    interrupted: str = ""


def take_rounds(
    what: str,
    rounds: int,
    one: Callable[[int], None],
    widths: Callable[[], Iterable[float]],
    report: Report,
) -> Taken:
    """Take so many rounds at most.

    one: takes the round of this number. widths: of all intervals, each a share of its median; NaN
    of what has none. Raises KeyboardInterrupt where not even the first round was whole.
    """
    for number in range(rounds):
        report(what, number, rounds)
        if number >= FEWEST_REPEATS and not any(width > SETTLED for width in widths()):
            rounds = number
            break
        try:
            one(number)
        except KeyboardInterrupt as end:
            if number == 0:
                raise
            by = f"{end or 'interrupted'}"
            return Taken(number, f"{by} after {number} of {rounds} rounds")
    report(what, rounds, rounds)
    return Taken(rounds)
