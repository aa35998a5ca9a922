"""Several generators in turns: a stage of each, then the next stage of each.

What they yield is asked for, and done for all of them at once.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from typing import Any, TypeVar

Result = TypeVar("Result")
Asked = TypeVar("Asked")


def in_turns(
    generators: Sequence[Generator[Asked | None, Any, Result]],
    together: Callable[[list[Asked]], Sequence[Any]],
) -> list[Result]:
    """Return what generators return, each advanced to its next `yield` in turns.

    together: returns an answer to each thing but None that they yielded in one turn; generators
    go on with theirs. What one of them raises is raised here, once the others are closed.
    """
    results: dict[int, Result] = {}
    going = dict(enumerate(generators))
    answers: dict[int, Any] = {}
    try:
        while going:
            asked: dict[int, Asked] = {}
            for place, one in list(going.items()):
                try:
                    what = one.send(answers.get(place))
                except StopIteration as end:
                    results[place] = end.value
                    del going[place]
                else:
                    if what is not None:
                        asked[place] = what
            answers = dict(zip(asked, together([*asked.values()]), strict=True)) if asked else {}
    finally:
        for one in going.values():
            one.close()
    return [results[place] for place in range(len(generators))]


def with_growth(
    generator: Generator[Asked, Any, Result], reading: Callable[[], int]
) -> Generator[Asked, Any, tuple[Result, int]]:
    """Return what a generator returns, and by how much a reading grew in its own stages.

    What others add to it in between is theirs.
    """
    growth, answer = 0, None
    try:
        while True:
            before = reading()
            try:
                what = generator.send(answer)
            except StopIteration as end:
                return end.value, growth + reading() - before
            growth += reading() - before
            answer = yield what
    finally:
        generator.close()
