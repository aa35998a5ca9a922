"""A gap may close, and no more: v_n >= -(phi - slop)/dt, and what does not touch is not braked."""

from __future__ import annotations

import pytest
from interpreted import interpreted
from plain_facts import facts, one_row, pair_facts

from lavendersim.engine.effects.speculative import EFFECT, make
from lavendersim.engine.spec import Spec

PARAMETERS = one_row(slop=0.001, dt=0.01)


def target_of(phi: float, v_n: float = -9.0, dv_n: float = 0.0, effects=()) -> float:
    contact = one_row(phi=phi, v_n_pre=v_n, dv_n=dv_n, target=0.0)
    interpreted(make(Spec(effects)))(contact, one_row(kind=0), PARAMETERS)
    return contact.target


@pytest.mark.parametrize(("phi", "target"), [(0.021, 2.0), (0.001, 0.0), (-0.01, 0.0)])
def test_the_slowest_allowed_speed_closes_the_gap_to_the_slop_in_a_step(phi, target) -> None:
    assert target_of(phi) == pytest.approx(target, abs=1e-14)


@pytest.mark.parametrize(("effect", "share"), [("midpoint", 0.5), ("impact_time", 0.0)])
def test_in_free_flight_a_row_that_is_not_reached_lets_pass_what_comes(effect, share) -> None:
    """The gap closes by v_n_pre less a share of what forces added, for a whole step."""
    phi = 0.02
    # Forces added -1 m/s; just not reached, and just reached, within the slop beyond the surface.
    limit = -(phi + 0.001) / 0.01 + share * -1.0
    # With room for round-off: a billionth of a millimetre a second and of the speed.
    free = target_of(phi, limit + 0.01, -1.0, (effect,)) + limit + 0.01
    assert 1e-12 < free < 1e-11
    assert target_of(phi, limit - 0.01, -1.0, (effect,)) == pytest.approx(1.9, abs=1e-12)


def test_it_is_on_where_it_is_asked_for_and_something_can_touch() -> None:
    pairs = (pair_facts("floor", "box"),)
    assert EFFECT.decide(facts(pairs=pairs, speculative=True)).on
    assert not EFFECT.decide(facts(pairs=pairs)).on
    assert not EFFECT.decide(facts(speculative=True)).on
