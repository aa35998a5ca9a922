"""Parts of resolved configs that are equal to the last bit, kept once.

The cells of a sweep differ in a few numbers: numerics, recording and most surfaces are the same in
all of them, and take three quarters of what a cell's config takes. Parts are frozen, so that one
object may stand in many configs.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final, TypeVar

Part = TypeVar("Part")  # a frozen model
Source = TypeVar("Source")  # likewise

KEPT: Final = 1024  # parts that are remembered; one that is forgotten is only kept once more


class _Equal:
    """A part, equal to others by what it says: 0.0 is not -0.0, and 1 is not 1.0."""

    __slots__ = ("content", "part")

    def __init__(self, part: object) -> None:
        self.part, self.content = part, (type(part), str(vars(part)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Equal) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


@lru_cache(maxsize=KEPT)
def _first(one: _Equal) -> Any:
    return one.part


def shared(part: Part) -> Part:
    """Return the first part that was equal to this one, as long as it is remembered."""
    first: Part = _first(_Equal(part))
    return first


@lru_cache(maxsize=KEPT)
def _made(one: _Equal, make: Callable[[Any], Any]) -> Any:
    return make(one.part)


# By the id of a part, which cannot be another's while the part stands here, and what makes of it.
_made_of: dict[tuple[int, Callable[[Any], Any]], tuple[object, Any]] = {}


def made_once(source: Source, make: Callable[[Source], Part]) -> Part:
    """Return what is made of a part of a config as written: once for all that are equal.

    make: a function of a module, of the part's fields alone.
    """
    known = _made_of.get((id(source), make))
    if known is None:
        if len(_made_of) >= KEPT:
            _made_of.clear()
        known = _made_of[id(source), make] = source, _made(_Equal(source), make)
    made: Part = known[1]
    return made
