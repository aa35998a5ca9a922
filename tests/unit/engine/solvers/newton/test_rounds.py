"""Rounds stiffen while they are kept, soften where they fail, and are the same compiled or not."""

from __future__ import annotations

import math

import pytest

from lavendersim.engine.compile import inner
from lavendersim.engine.solvers.newton import rounds
from lavendersim.engine.solvers.newton.rounds import (
    CUT,
    FIRST,
    SOFTEST,
    STIFF_ENOUGH,
    STIFFEST,
    WORSE,
    Rounds,
    after_failed,
    after_kept,
    after_stalled,
    back_to,
    begin_rounds,
    is_at_minimum,
    is_idle,
    is_kept,
)


def test_softness_falls_by_one_factor_to_the_stiffest_and_stays() -> None:
    now, soft = begin_rounds(SOFTEST), []
    for _ in range(10):
        soft.append(now.softness)
        now = after_kept(now)
    expected = [max(SOFTEST * CUT**k, STIFFEST) for k in range(10)]
    assert soft == pytest.approx(expected, rel=1e-14)  # ten products, each rounded


def test_after_a_stiff_first_round_that_fails_the_next_is_the_softest() -> None:
    failed = after_failed(begin_rounds(1e-6), keeps_cut=True)
    assert failed.softness == pytest.approx(SOFTEST, rel=1e-15)
    assert (failed.cut, failed.failed) == (CUT, 1)


def test_no_round_that_failed_is_made_again() -> None:
    """Kept at s, the next at s CUT fails: what follows lies between them, nearer s each time."""
    kept = after_kept(begin_rounds(SOFTEST))
    soft = [kept.softness]
    for _ in range(4):
        kept = after_failed(kept, keeps_cut=False)
        soft.append(kept.softness)
    expected = [SOFTEST * CUT ** (0.5**k) for k in range(5)]
    assert soft == pytest.approx(expected, rel=1e-14)


def test_rounds_that_went_astray_go_on_beside_the_one_that_left_the_least() -> None:
    """Not beside the last that was kept, and by the cuts that failures have made small."""
    astray = after_kept(after_kept(begin_rounds(SOFTEST)))
    for _ in range(4):
        astray = after_failed(astray, keeps_cut=False)
    now = back_to(astray, SOFTEST)
    assert now.softness == pytest.approx(SOFTEST * CUT ** (0.5**4), rel=1e-14)
    assert (now.good, now.failed) == (SOFTEST, 0)


def test_the_first_round_has_to_bring_the_residual_down_and_later_ones_may_raise_it() -> None:
    for first, share in ((True, FIRST), (False, WORSE)):
        assert is_kept(0.99 * share, 1.0, first)
        assert not is_kept(1.01 * share, 1.0, first)
        assert not is_kept(math.nan, 1.0, first)


@pytest.mark.parametrize("slope", [0.0, 1e-30, -1e-9, math.nan])
def test_a_step_with_nothing_to_gain_is_the_last(slope: float) -> None:
    """Uphill by round-off, less than what is enough, or no number at all."""
    assert is_at_minimum(slope, -1.0, 1e-8)
    assert not is_at_minimum(-1e-7, -1.0, 1e-8)


def test_rounds_that_bring_little_are_stiff_enough_and_no_stiffer() -> None:
    now, soft = begin_rounds(SOFTEST), []
    for _ in range(5):
        soft.append(now.softness)
        now = after_stalled(now)
    expected = [max(SOFTEST * CUT**k, STIFF_ENOUGH) for k in range(5)]
    assert soft == pytest.approx(expected, rel=1e-14)
    stiff = Rounds(STIFFEST, STIFFEST, CUT, 0)  # one that is stiffer already stays as it is
    assert after_stalled(stiff).softness == STIFFEST


def test_steps_that_gain_as_much_as_the_one_before_are_idle_where_it_is_next_to_nothing() -> None:
    assert is_idle(-2e-28, -1e-28, -1.0)
    assert not is_idle(-1e-28, -2e-28, -1.0)  # it still falls
    assert not is_idle(-0.2, -0.1, -1.0)  # contacts change their state


@pytest.mark.parametrize(
    ("name", "more"), [("after_kept", ()), ("after_stalled", ()), ("after_failed", (False,))]
)
def test_kernels_and_plain_functions_have_the_same_bits(name: str, more: tuple[bool, ...]) -> None:
    """Square roots and products are rounded once, by IEEE 754, in both."""
    plain = getattr(rounds, name)
    compiled = inner(plain)
    now = Rounds(3e-4 / 7.0, 1e-2 / 3.0, 0.03, 2)
    for _ in range(5):
        following = plain(now, *more)
        assert tuple(compiled(now, *more)) == tuple(following)
        now = following
