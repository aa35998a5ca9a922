"""Algorithms that have only so many iterations: how often they took them all, in words.

Light: who lists or shows runs needs no more.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# Columns of /step that count such calls, and what each call is of. It went on with what it had
# found so far, and its step is as accurate as that is.
AT_LIMIT: Final = {
    "gjk_not_converged": "distances of convex bodies by GJK",
    "epa_not_converged": "depths of convex bodies by EPA",
    "stronge_not_converged": "impacts by Stronge's law",
}


def limits_in_words(counts: Mapping[str, int]) -> str:
    """Return which algorithms did not converge, and how often; empty where all did."""
    found = [f"{count} {AT_LIMIT[name]}" for name, count in counts.items() if count]
    return f"{', '.join(found)} did not converge" if found else ""
