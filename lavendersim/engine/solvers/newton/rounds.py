"""Rounds of the augmented Lagrangian: how soft each is, when one is kept, when it is at its end.

A round is a convex problem of softness s around the impulses before it; Newton's method descends on
it. The softer, the fewer contacts change their state in a round; the stiffer, the more a round
brings. So softness falls by CUT from a round that is kept to the next, and by less where the next
one fails.

The same for the bodies of a scene (`method`, in kernels) and for problems by themselves
(`lavendersim.problems.newton_rounds`, over contacts): functions of numbers, compiled or not.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

# Softness of the second round where the first failed, and the least [-].
SOFTEST = 1e-2
STIFFEST = 1e-8
# The least where the shifts are what is off: a stiffer round brings no more, and what slides at v
# has impulses with round-off of 1e-16 v over the softness [-].
STIFF_ENOUGH = 1e-6
# Softness falls by this factor from round to round, by its root after one that failed: the same
# round again would fail again [-].
CUT = 0.03
# Rounds that may fail before the method is given up.
FAILURES = 6
# A round may leave the largest residual this much above the least so far: it falls on average. What
# is handed on is the least.
WORSE = 10.0
# The first round has to bring it down to this share: it is stiff, and mostly it is the last.
FIRST = 0.1
# A round's impulses may be this share of the residual, squared, off the minimum's [-].
EXACTNESS = 0.01
# Newton steps of a round at most. The one that finds every contact in its final state is the last
# but one.
STEPS_OF_A_ROUND = 24
# By this step the gain of the next one has fallen to this share, or the round is given up [-].
LOOK_BACK, LOOKED_FOR = 8, 0.1
# Nothing is left to gain below this share of what the first step gains: round-off [-].
ROUND_OFF = 1e-20
# Below this share steps that gain no less than the one before are round-off [-]; so many of them
# end a round.
NOTHING, IDLE_STEPS = 1e-8, 2
# A length is good when it leaves this share of the slope along the step [-]; trials of it. Scenes
# halve the interval, where a slope costs next to nothing; problems by themselves go by secants.
SLOPE_LEFT = 0.2
LENGTHS = 40


class Rounds(NamedTuple):
    """Where the rounds are."""

    softness: float  # of the next one [-]
    good: float  # of the last that was kept [-]
    cut: float  # factor on the softness from a round to the next [-]
    failed: int  # rounds that were not kept


def begin_rounds(softness: float) -> Rounds:
    """Return the rounds before the first one, of a softness [-]."""
    return Rounds(softness, SOFTEST / CUT, CUT, 0)


def is_kept(residual: float, least: float, first: bool) -> bool:
    """Whether a round's residual is low enough to go on from; least: so far."""
    return residual < (FIRST if first else WORSE) * least


def after_kept(rounds: Rounds) -> Rounds:
    """Return the rounds after one that is kept."""
    softness = max(rounds.softness * rounds.cut, STIFFEST)
    return Rounds(softness, rounds.softness, rounds.cut, rounds.failed)


def after_stalled(rounds: Rounds) -> Rounds:
    """Return the rounds after one that is kept and brought little: stiff enough, and no stiffer."""
    softness = max(rounds.softness * rounds.cut, min(rounds.softness, STIFF_ENOUGH))
    return Rounds(softness, rounds.softness, rounds.cut, rounds.failed)


def back_to(rounds: Rounds, softness: float) -> Rounds:
    """Return the rounds that go on, by small cuts, from the one of this softness."""
    return Rounds(softness * rounds.cut, softness, rounds.cut, 0)


def after_failed(rounds: Rounds, keeps_cut: bool) -> Rounds:
    """Return the rounds after one that is not kept; keeps_cut: that says nothing of the cut."""
    cut = rounds.cut if keeps_cut else sqrt(rounds.cut)
    return Rounds(rounds.good * cut, rounds.good, cut, rounds.failed + 1)


def is_at_minimum(slope: float, first: float, enough: float) -> bool:
    """Whether a step along which the function has this slope has nothing to gain.

    first: slope of the round's first step; enough: the slope need not be steeper.
    """
    return not slope < min(ROUND_OFF * first, -enough)


def is_idle(slope: float, before: float, first: float) -> bool:
    """Whether a step gains no less than the one before it, and next to nothing: round-off.

    What the function has lost since the round's first step may be no digit of what it is made of.
    """
    return slope > NOTHING * first and slope <= before


def is_slow(step: int, slope: float, first: float) -> bool:
    """Whether a round is given up for its step of this number."""
    return step == LOOK_BACK and slope < LOOKED_FOR * first
