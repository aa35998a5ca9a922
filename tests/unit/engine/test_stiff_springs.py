"""Impacts of springs that steps do not resolve: what damping gives back, and which take time."""

from __future__ import annotations

from math import acos, acosh, exp, sqrt

import numpy as np
import pytest
from interpreted import interpreted
from plain_facts import one_row
from test_foreseen_impacts import HAIR, SPRUNG, Row

from lavendersim.engine.approach import NEVER
from lavendersim.engine.spec import Spec
from lavendersim.engine.stiff_springs import (
    FAST,
    decay,
    has_impacts,
    make_restitution_of,
    make_takes_time,
    rebound,
)

ORDERED = Spec(effects=("compliance", "contact_spring", "impact_time", "impact_order"))
IN_TIME = Spec(effects=("compliance", "contact_spring", "impact_time"))
RATIOS = [0.0, 1e-6, 0.2, 0.7, 1.0 - 1e-7, 1.0, 1.0 + 1e-7, 1.5, 20.0, 1e3]
C, MASS, STEP = 1e-6, 2.0, 0.01


def parted_at(ratio: float) -> float:
    """Return -d'/v where d'' first is 0, by d = exp(-zeta t) sin(w t)/w, w = 1 - zeta^2 above 0.

    d'' = 0 where tan(w t) = 2 zeta w/(2 zeta^2 - 1); over the critical damping of tanh.
    """
    if ratio == 1.0:
        return exp(-2.0)  # d' = (1 - t) exp(-t), d'' = (t - 2) exp(-t)
    if ratio < 1.0:
        w = sqrt(1.0 - ratio**2)
        angle = np.arctan2(2.0 * ratio * w, 2.0 * ratio**2 - 1.0)
        speed = np.cos(angle) - ratio / w * np.sin(angle)
        return float(-np.exp(-ratio * angle / w) * speed)
    w = sqrt(ratio**2 - 1.0)  # d' = exp(-zeta t) (cosh(w t) - zeta/w sinh(w t))
    t = np.arctanh(2.0 * ratio * w / (2.0 * ratio**2 - 1.0)) / w
    growing, falling = np.exp((w - ratio) * t), np.exp(-(w + ratio) * t)
    return float(0.5 * ((ratio / w - 1.0) * growing - (ratio / w + 1.0) * falling))


@pytest.mark.parametrize("ratio", RATIOS)
def test_what_it_gives_back_is_the_speed_where_nothing_pushes_any_more(ratio: float) -> None:
    # Near the critical damping the closed form loses the digits of 1 - zeta^2, 2e-7 of it: 1e-9.
    # Far above it w - zeta = -1/(2 zeta) loses those of zeta^2, 1e-10 at 1e3; of the series' sums
    # a thousand squarings make 1e-13.
    assert interpreted(rebound)(ratio) == pytest.approx(parted_at(ratio), rel=1e-8)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.7, 2.0, 5.0])
def test_what_it_gives_back_is_that_of_an_angle(ratio: float) -> None:
    """exp(-2 a cot a) has no difference of nearly equal numbers there."""
    if ratio < 1.0:
        angle = acos(ratio)
        expected = exp(-2.0 * angle * ratio / sqrt(1.0 - ratio**2))
    else:
        angle = acosh(ratio)
        expected = exp(-2.0 * angle * ratio / sqrt(ratio**2 - 1.0))
    assert interpreted(rebound)(ratio) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("y", [0.0, 0.3, 2.0, 10.0, 29.0])
def test_decay_is_the_exponential(y: float) -> None:
    # 2^10 factors of which each is rounded; the first term left out is (29/1024)^8/8! = 1e-17.
    assert interpreted(decay)(y) == pytest.approx(exp(-y), rel=1024 * 2.0**-53)


@pytest.mark.parametrize(("share", "takes_time"), [(0.999, True), (1.001, False)])
def test_what_steps_resolve_takes_time(share: float, takes_time: bool) -> None:
    """x^2 = dt^2/(m c) of 4, by the masses of both bodies."""
    step = sqrt(share * FAST * MASS * C)
    bodies = [one_row(inv_m=0.25 / MASS), one_row(inv_m=0.75 / MASS)]
    contact, params = one_row(a=0, b=1), one_row(timestep=step, dt=0.1 * step)
    pair, rigid = one_row(compliance=C), one_row(compliance=0.0)
    for spec, soft in ((ORDERED, takes_time), (IN_TIME, True)):
        kernel = interpreted(make_takes_time(spec))
        assert kernel(contact, pair, bodies, params) == soft
        assert not kernel(contact, rigid, bodies, params)


def test_impacts_of_springs_need_an_order_and_no_accuracy() -> None:
    assert has_impacts(ORDERED)
    assert not has_impacts(IN_TIME)
    assert not has_impacts(ORDERED.including("error_control"))
    assert not has_impacts(Spec(effects=("impact_time", "impact_order")))


def test_surfaces_without_a_spring_give_back_their_restitution() -> None:
    both = interpreted(make_restitution_of(ORDERED.including("restitution")))
    soft = one_row(compliance=C, damping_ratio=1.0, restitution=0.9)
    rigid = one_row(compliance=0.0, damping_ratio=1.0, restitution=0.9)
    assert both(soft, 1.0) == pytest.approx(exp(-2.0), rel=1e-12)
    assert both(rigid, 1.0) == 0.9
    alone = interpreted(make_restitution_of(ORDERED))
    assert alone(one_row(compliance=0.0, damping_ratio=0.0), 1.0) == 0.0


def stiff(phi: float, v: float, a: float = 0.0, ratio: float = 1.0) -> tuple[bool, bool, float]:
    """Foresee of a ball of 1 kg on a spring of dt^2/(m c) = 100."""
    row = Row(SPRUNG, compliance=0.01 * STEP**2, damping_ratio=ratio).moves(phi, v, a)
    row.bodies["inv_m"][1] = 1.0
    return row.foresee()


def test_springs_that_steps_do_not_resolve_have_impacts() -> None:
    assert stiff(0.0, -1.0) == (True, False, NEVER)
    assert stiff(1e-3, -1.0) == (False, True, pytest.approx(1e-3, rel=1e-12))
    assert stiff(0.0, 1.0)[0] is False


def test_what_presses_such_a_spring_has_one_as_it_is_faster_than_its_load_makes_it() -> None:
    """Forces change 10 m/s^2 in a step; of what is undamped the spring gives all back."""
    load, depth = 10.0 * STEP, -1e-5
    for share, expected in ((1.0 + HAIR, True), (1.0 - HAIR, False)):
        assert stiff(depth, -share * load, -10.0) == (expected, False, NEVER)
    assert stiff(depth, -2.0 * load, -10.0, 0.0) == (False, False, NEVER)
    assert stiff(depth, 2.0 * load, -10.0) == (False, False, NEVER)
