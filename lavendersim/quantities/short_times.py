"""Times for people: three digits, and the unit that leaves some of them before the point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

PLAIN: Final = ("s", "ms", "us", "ns")
ON_PAGES: Final = ("s", "ms", "\u00b5s")


def short_time(seconds: float, units: Sequence[str] = PLAIN) -> str:
    """Return a time in words. units: from seconds down, each a thousandth of the one before."""
    size = 1.0
    for unit in units[:-1]:
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
        size /= 1000.0
    return f"{seconds / size:.3g} {units[-1]}"
