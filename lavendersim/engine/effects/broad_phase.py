"""Broad phase: which bodies come near each other a tree tells, not a look at every pair."""

from ..collide.broad.broad_phase import make
from .decision import Decision, Facts

__all__ = ["BODY_FIELDS", "MOST_PAIRS", "NAME", "STAGE", "make", "wanted"]

NAME = "broad_phase"
STAGE = "collide"
BODY_FIELDS = [("material", "i8")]  # row of the body's class in the table of templates
# The narrow phase's own first look at a pair costs 10 ns (spheres) to 50 ns (boxes): up to here at
# most 25 us a step, which is not worth four seconds of compiling.
MOST_PAIRS = 512


def wanted(facts: Facts) -> Decision:
    """On when more pairs of bodies may touch than are worth looking at one by one."""
    if facts.pair_count > MOST_PAIRS:
        return Decision(
            True, f"{facts.pair_count} pairs of bodies may touch: only those that are near are kept"
        )
    few = "no" if facts.pair_count == 0 else f"only {facts.pair_count}"
    noun = "pair" if facts.pair_count == 1 else "pairs"
    return Decision(False, f"{few} {noun} of bodies may touch: each is looked at")
