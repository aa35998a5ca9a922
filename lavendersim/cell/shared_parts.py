"""Parts of resolved configs that are equal to the last bit, kept once.

The cells of a sweep differ in a few numbers: numerics, recording and most surfaces are the same in
all of them, and take three quarters of what a cell's config takes. Parts are frozen, so that one
object may stand in many configs.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final, TypeVar

from lavendersim.quantities.model import ConfigModel, ResolvedModel

Part = TypeVar("Part", bound=ConfigModel | ResolvedModel)

KEPT: Final = 1024  # parts that are remembered; one that is forgotten is only kept once more


class _Equal:
    """A part, equal to others by what it says: 0.0 is not -0.0, and 1 is not 1.0."""

    __slots__ = ("content", "part")

    def __init__(self, part: ConfigModel | ResolvedModel) -> None:
        self.part, self.content = part, (type(part), str(vars(part)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Equal) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


@lru_cache(maxsize=KEPT)
def _first(one: _Equal) -> ConfigModel | ResolvedModel:
    return one.part


def shared(part: Part) -> Part:
    """Return the first part that was equal to this one, as long as it is remembered."""
    first = _first(_Equal(part))
    assert type(first) is type(part)
    return first
