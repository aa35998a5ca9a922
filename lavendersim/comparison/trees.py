"""Differences of two trees of plain data, by path: `scene.bodies.ball.mass`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

ABSENT: Final = "(absent)"


class Difference(NamedTuple):
    """A leaf in which two trees differ; ABSENT where one has none."""

    path: str
    a: Any
    b: Any


def differences(a: Any, b: Any, path: str = "") -> Iterator[Difference]:
    """Yield the leaves that differ, in the order of `a`, then those that `b` alone has."""
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for key in dict.fromkeys((*a, *b)):
            below = f"{path}.{key}" if path else str(key)
            yield from differences(a.get(key, ABSENT), b.get(key, ABSENT), below)
    elif _is_list(a) and _is_list(b) and any(map(_has_parts, (*a, *b))):
        for place in range(max(len(a), len(b))):
            left, right = (one[place] if place < len(one) else ABSENT for one in (a, b))
            yield from differences(left, right, f"{path}.{place}")
    elif not equal(a, b):
        yield Difference(path, a, b)


def equal(a: Any, b: Any) -> bool:
    """Whether two leaves are the same: numbers by value (1/4 is 0.25), NaN is NaN."""
    if isinstance(a, bool) or isinstance(b, bool):
        return a is b
    if isinstance(a, int | float) and isinstance(b, int | float):
        return a == b or (math.isnan(a) and math.isnan(b))
    if _is_list(a) and _is_list(b):
        return len(a) == len(b) and all(map(equal, a, b))
    return bool(a == b)


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple)


def _has_parts(value: Any) -> bool:
    return isinstance(value, Mapping) or _is_list(value)
