"""Several generators in turns: a stage of each, then the next stage of each."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import TypeVar

Result = TypeVar("Result")


def in_turns(generators: Sequence[Generator[None, None, Result]]) -> list[Result]:
    """Return what generators return, each advanced to its next `yield` in turns.

    What one of them raises is raised here, once the others are closed.
    """
    results: dict[int, Result] = {}
    going = dict(enumerate(generators))
    try:
        while going:
            for place, one in list(going.items()):
                try:
                    next(one)
                except StopIteration as end:
                    results[place] = end.value
                    del going[place]
    finally:
        for one in going.values():
            one.close()
    return [results[place] for place in range(len(generators))]
