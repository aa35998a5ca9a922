"""Algorithms that have only so many iterations: how often they took them all, in words.

Light: who lists or shows runs needs no more.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# Columns of /step that count such calls, and what each call is of. It went on with what it had
# found so far, and its step is as accurate as that is. `least_norm_not_converged` is not of them:
# which of equal forces are chosen moves nothing.
AT_LIMIT: Final = {
    "gjk_not_converged": "distances of convex bodies by GJK",
    "epa_not_converged": "depths of convex bodies by EPA",
    "ascent_not_converged": "depths of round bodies by ascent",
    "advance_not_converged": "meetings of fast bodies by conservative advancement",
    "impact_not_converged": "times of impact by Newton's method",
    "stronge_not_converged": "impacts by Stronge's law",
    "midpoint_not_converged": "contacts at the middle of a step by fixed-point passes",
    "gyroscopic_not_converged": "turns to the middle of a step by Newton's method",
    "spring_not_converged": "impulses of springs by Newton's method",
}


def limits_in_words(counts: Mapping[str, int]) -> str:
    """Return which algorithms did not converge, and how often; empty where all did."""
    found = [f"{counts[name]} {what}" for name, what in AT_LIMIT.items() if counts.get(name)]
    return f"{', '.join(found)} did not converge" if found else ""
